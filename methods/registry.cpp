// SPDX-License-Identifier: MIT
#include "methods/registry.h"

#include "core/text.h"
#include "methods/controls/controls.h"
#include "methods/dufomap/dufomap.h"
#include "methods/erasor/erasor.h"
#include "methods/octomap/octomap.h"
#include "methods/peopleremover/peopleremover.h"
#include "methods/raymoval/raymoval.h"
#include "methods/raymoval_plus/raymoval_plus.h"
#include "methods/removert/removert.h"

namespace raymoval {

const MethodRegistry& MethodRegistry::built_in() {
  static const MethodRegistry registry = [] {
    MethodRegistry methods;
    methods.add(noop_entry());
    methods.add(remove_all_entry());
    methods.add(oracle_entry());
    methods.add(raymoval_entry());
    methods.add(raymoval_plus_entry());
    methods.add(octomap_entry());
    methods.add(peopleremover_entry());
    methods.add(removert_entry());
    methods.add(erasor_entry());
    methods.add(dufomap_entry());
    return methods;
  }();
  return registry;
}

void MethodRegistry::add(MethodEntry entry) {
  for (const auto& known : entries_) {
    if (known->name == entry.name) {
      throw ConfigurationError("two methods are called '" + entry.name + "'; rename one.");
    }
  }
  if (entry.variants.empty()) {
    throw ConfigurationError("method '" + entry.name + "' needs at least one variant.");
  }
  entries_.push_back(std::make_unique<MethodEntry>(std::move(entry)));
}

const MethodEntry& MethodRegistry::find(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& entry : entries_) {
    if (entry->name == name) return *entry;
    names.push_back(entry->name);
  }
  throw UsageError("method '" + name + "' is unknown." + suggestion(name, names));
}

ConfiguredMethod MethodRegistry::configure(const std::string& name_and_variant) const {
  const std::size_t colon = name_and_variant.find(':');
  const MethodEntry& entry = find(name_and_variant.substr(0, colon));
  ConfiguredMethod method;
  method.entry = &entry;
  method.variant = entry.variants.front();
  if (colon != std::string::npos) {
    const std::string wanted = name_and_variant.substr(colon + 1);
    std::vector<std::string> names;
    bool found = false;
    for (const MethodVariant& variant : entry.variants) {
      names.push_back(variant.name);
      if (variant.name == wanted) {
        method.variant = variant;
        found = true;
      }
    }
    if (!found) {
      throw UsageError("method '" + entry.name + "' has no variant '" + wanted + "'." +
                       suggestion(wanted, names));
    }
  }
  for (const ParameterSpec& spec : entry.parameters) {
    method.configuration.emplace_back(spec.name, spec.default_value);
  }
  for (const auto& [name, value] : method.variant.overrides) {
    set_parameter(method.configuration, name, value);
  }
  return method;
}

}  // namespace raymoval
