// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters.h"
#include "methods/remover.h"

namespace raymoval {

/// A named set of parameter values of a method.
struct MethodVariant {
  std::string name;
  std::string sentence;
  bool online = false;      ///< Answers for scan t from scans 0 .. t only.
  Configuration overrides;  ///< Values that differ from the method's defaults.
};

/// Everything the rest of the program knows about a method.
struct MethodEntry {
  std::string name;
  std::string sentence;
  std::string source;              ///< Paper or origin.
  std::string version = "1";       ///< Raised whenever answers may change.
  std::vector<std::string> notes;  ///< Decisions and deviations, a sentence each.
  std::vector<ParameterSpec> parameters;
  std::vector<MethodVariant> variants;  ///< The first is what the bare name means.
  bool needs_truth = false;             ///< A control that is given the labels (`oracle`).
  std::string manifest = {};            ///< Path of the manifest of an external method.
  std::function<std::unique_ptr<Remover>(const Configuration&)> make;
};

/// A method with its variant and every parameter's value: what a result is traced to.
struct ConfiguredMethod {
  const MethodEntry* entry = nullptr;
  MethodVariant variant;
  Configuration configuration;
  std::shared_ptr<const MethodEntry> owned = {};  ///< `entry`, if no registry has it.

  /// "raymoval:online".
  [[nodiscard]] std::string full_name() const { return entry->name + ":" + variant.name; }
  /// What `MethodRegistry::configure` finds it by, in another process too.
  [[nodiscard]] std::string address() const {
    return entry->manifest.empty() ? full_name() : "external:" + entry->manifest;
  }
  [[nodiscard]] std::unique_ptr<Remover> make() const { return entry->make(configuration); }
};

/// The methods by name, in the order in which they are shown.
class MethodRegistry {
 public:
  /// The methods that come with raymoval.
  static const MethodRegistry& built_in();

  /// @throws ConfigurationError if the name is taken, or an entry has no variant.
  void add(MethodEntry entry);
  [[nodiscard]] const std::vector<std::unique_ptr<MethodEntry>>& entries() const {
    return entries_;
  }
  /// @throws UsageError suggesting the nearest name.
  [[nodiscard]] const MethodEntry& find(const std::string& name) const;
  /// "raymoval", "raymoval:online" or "external:PATH/manifest.json" with its defaults.
  /// @throws UsageError suggesting the nearest name; ConfigurationError or DataError for a manifest
  [[nodiscard]] ConfiguredMethod configure(const std::string& name_and_variant) const;

 private:
  [[nodiscard]] ConfiguredMethod configure_external(const std::string& manifest) const;

  std::vector<std::unique_ptr<MethodEntry>> entries_;
};

}  // namespace raymoval
