// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/cli/command.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// Options for the content of a run: a suite file, or single sequences and methods.
struct SuiteFlags {
  std::string suite, data, as, threads, time_limit, memory_limit;
  std::vector<std::string> sequences, methods, settings, protocols;
  SequenceFlags sequence;

  void add_to(CommandOptions& options);
  /// The suite with its controls. @throws UsageError or ConfigurationError
  [[nodiscard]] Suite resolved() const;
};

/// Warns on standard error of each setting without effect.
void warn_of_settings_without_effect(const Suite& suite);

}  // namespace raymoval
