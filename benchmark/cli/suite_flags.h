// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/cli/commands.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// Options that say what is run: a suite file, or sequences and methods one by one.
struct SuiteFlags {
  std::string suite, data, threads, time_limit, memory_limit;
  std::vector<std::string> sequences, methods, settings, protocols;
  SequenceFlags sequence;

  void add_to(CommandOptions& options);
  /// The suite with its controls. @throws UsageError or ConfigurationError
  [[nodiscard]] Suite resolved() const;
};

/// Tells on standard error which settings change nothing, a line each.
void warn_of_settings_without_effect(const Suite& suite);

}  // namespace raymoval
