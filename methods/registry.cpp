// SPDX-License-Identifier: MIT
#include "methods/registry.h"

#include <algorithm>

#include "core/text.h"
#include "methods/beautymap/beautymap.h"
#include "methods/controls/controls.h"
#include "methods/dufomap/dufomap.h"
#include "methods/dynablox/dynablox.h"
#include "methods/erasor/erasor.h"
#include "methods/external/external.h"
#include "methods/freedom/freedom.h"
#include "methods/hmm_mos/hmm_mos.h"
#include "methods/mapcleaner/mapcleaner.h"
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
    methods.add(beautymap_entry());
    methods.add(freedom_entry());
    methods.add(hmm_mos_entry());
    methods.add(dynablox_entry());
    methods.add(mapcleaner_entry());
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
  for (const std::string& name : entry.main_parameters) {
    (void)find_parameter(entry.name, entry.parameters, name);
  }
  entries_.push_back(std::make_shared<const MethodEntry>(std::move(entry)));
}

const MethodEntry& MethodRegistry::find(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& entry : entries_) {
    if (entry->name == name) return *entry;
    names.push_back(entry->name);
  }
  throw UsageError("method '" + name + "' is unknown." + suggestion(name, names));
}

namespace {

const MethodVariant& find_variant(const MethodEntry& entry, const std::string& wanted) {
  std::vector<std::string> names;
  for (const MethodVariant& variant : entry.variants) {
    if (variant.name == wanted) return variant;
    names.push_back(variant.name);
  }
  throw UsageError("method '" + entry.name + "' has no variant '" + wanted + "'." +
                   suggestion(wanted, names));
}

ConfiguredMethod with_defaults(const MethodEntry& entry, const MethodVariant& variant) {
  ConfiguredMethod method;
  method.entry = &entry;
  method.variant = variant;
  for (const ParameterSpec& spec : entry.parameters) {
    method.configuration.emplace_back(spec.name, spec.default_value);
  }
  for (const auto& [name, value] : variant.overrides) {
    set_parameter(method.configuration, name, value);
  }
  return method;
}

}  // namespace

Configuration ConfiguredMethod::changed_from() const {
  Configuration changed = with_defaults(*entry, variant).configuration;
  std::erase_if(changed, [&](const auto& usual) {
    return std::ranges::find(configuration, usual) != configuration.end();
  });
  return changed;
}

ConfiguredMethod MethodRegistry::configure(const std::string& name_and_variant) const {
  if (const auto manifest = external_manifest(name_and_variant)) {
    return configure_external(manifest->string());
  }
  if (name_and_variant.find(',') != std::string::npos) {
    throw UsageError("method '" + name_and_variant +
                     "': one at a time; give --method once for each of them.");
  }
  const std::size_t colon = name_and_variant.find(':');
  const MethodEntry& entry = find(name_and_variant.substr(0, colon));
  if (colon == std::string::npos) return with_defaults(entry, entry.variants.front());
  return with_defaults(entry, find_variant(entry, name_and_variant.substr(colon + 1)));
}

ConfiguredMethod MethodRegistry::configure_external(const std::string& manifest) const {
  const auto entry = std::make_shared<const MethodEntry>(external_entry(manifest));
  for (const auto& known : entries_) {
    if (known->name == entry->name) {
      throw ConfigurationError(entry->manifest + ": the name '" + entry->name +
                               "' is that of a method of raymoval; give it another one.");
    }
  }
  ConfiguredMethod method = with_defaults(*entry, entry->variants.front());
  method.owned = entry;
  return method;
}

}  // namespace raymoval
