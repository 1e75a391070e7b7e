// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "methods/registry.h"

namespace raymoval {

/// A list of BibTeX entries, each once: the entry of this program, then the added ones. A method of
/// this project adds nothing, a method without a publication adds a comment.
class Citations {
 public:
  /// @param methods must outlive this object
  explicit Citations(const MethodRegistry& methods);

  void add_method(const MethodEntry& entry);
  /// The methods and protocols of a run.
  void add_run(const RunRecord& run);
  void add(const std::string& entry);

  /// The method with this name, with or without a variant; null if there is none.
  [[nodiscard]] const MethodEntry* known_method(const std::string& full_name) const;
  [[nodiscard]] std::string text() const;

 private:
  const MethodRegistry& methods_;
  std::vector<std::string> entries_;
};

}  // namespace raymoval
