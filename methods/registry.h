// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "methods/method_entry.h"

namespace raymoval {

/// The methods by name, in the order in which they are shown. Copies share their entries.
class MethodRegistry {
 public:
  /// The methods that come with raymoval.
  static const MethodRegistry& built_in();

  /// @throws ConfigurationError if the name is taken, or the entry has no variant.
  void add(MethodEntry entry);
  [[nodiscard]] const std::vector<std::shared_ptr<const MethodEntry>>& entries() const {
    return entries_;
  }
  /// @throws UsageError that suggests the nearest name
  [[nodiscard]] const MethodEntry& find(const std::string& name) const;
  /// The method named "raymoval", "raymoval:online" or "external:PATH/manifest.json", with its
  /// variant's values.
  /// @throws UsageError that suggests the nearest name; ConfigurationError or DataError for a
  /// manifest
  [[nodiscard]] ConfiguredMethod configure(const std::string& name_and_variant) const;

 private:
  [[nodiscard]] ConfiguredMethod configure_external(const std::string& manifest) const;

  std::vector<std::shared_ptr<const MethodEntry>> entries_;
};

}  // namespace raymoval
