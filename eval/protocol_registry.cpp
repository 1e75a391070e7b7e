// SPDX-License-Identifier: MIT
#include "eval/protocol_registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "eval/built_in_protocols.h"

namespace raymoval {
namespace {

template <class List>
auto* find_named(List& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

/// Adds the specs to `all` that it lacks. @throws ConfigurationError if it has another of that name
template <class Spec>
void unite(const std::vector<Spec>& specs, const std::string& protocol, std::vector<Spec>& all) {
  for (const Spec& spec : specs) {
    const Spec* known = find_named(all, spec.name);
    if (known == nullptr) {
      all.push_back(spec);
    } else if (!(*known == spec)) {
      throw ConfigurationError(
          fmt::format("protocol {} describes '{}' differently from an earlier protocol. Use the "
                      "same description, or another name.",
                      protocol, spec.name));
    }
  }
}

void check_formulas(const ProtocolEntry& entry) {
  for (const RateSpec& spec : entry.rates) {
    if (!spec.formula) continue;
    for (const std::string& part : {spec.formula->first, spec.formula->second}) {
      if (find_named(entry.rates, part) != nullptr) continue;
      throw ConfigurationError(fmt::format(
          "protocol {}: rate {} follows from '{}', which is not a rate of the protocol.",
          entry.name, spec.name, part));
    }
  }
}

struct Registry {
  std::deque<ProtocolEntry> entries;
  std::vector<RateSpec> rates;
  std::vector<CountSpec> counts;

  void add(ProtocolEntry entry) {
    if (find_named(entries, entry.name) != nullptr) {
      throw ConfigurationError(
          fmt::format("a protocol called '{}' is registered already.", entry.name));
    }
    check_formulas(entry);
    std::vector<RateSpec> all_rates = rates;
    std::vector<CountSpec> all_counts = counts;
    unite(entry.rates, entry.name, all_rates);
    unite(entry.counts, entry.name, all_counts);
    rates = std::move(all_rates);
    counts = std::move(all_counts);
    entries.push_back(std::move(entry));
  }
};

/// The built-in protocols; the first one is the default.
Registry built_in_protocols() {
  Registry registry;
  registry.add(erasor_protocol_entry());
  registry.add(dynamicmap_protocol_entry());
  registry.add(strict_protocol_entry());
  registry.add(mos_protocol_entry());
  return registry;
}

Registry& protocol_registry() {
  static Registry registry = built_in_protocols();
  return registry;
}

}  // namespace

const std::deque<ProtocolEntry>& protocol_entries() {
  return protocol_registry().entries;
}

const ProtocolEntry* find_protocol(const std::string& name) {
  return find_named(protocol_entries(), name);
}

const ProtocolEntry& protocol_entry(const std::string& name) {
  const ProtocolEntry* entry = find_protocol(name);
  if (entry != nullptr) return *entry;
  std::vector<std::string> names;
  for (const ProtocolEntry& known : protocol_entries()) names.push_back(known.name);
  throw UsageError("protocol '" + name + "' is unknown." + suggestion(name, names));
}

const std::string& default_protocol() {
  return protocol_entries().front().name;
}

Configuration protocol_defaults(const std::string& name) {
  return default_options(protocol_entry(name));
}

std::unique_ptr<Protocol> make_protocol(const std::string& name, const Configuration& options) {
  return std::make_unique<Protocol>(protocol_entry(name), options);
}

void register_protocol(ProtocolEntry entry) {
  protocol_registry().add(std::move(entry));
}

void unregister_protocol(const std::string& name) {
  std::deque<ProtocolEntry> left = protocol_entries();
  std::erase_if(left, [&](const ProtocolEntry& entry) { return entry.name == name; });
  protocol_registry() = {};
  for (ProtocolEntry& entry : left) protocol_registry().add(std::move(entry));
}

const std::vector<RateSpec>& rate_specs() {
  return protocol_registry().rates;
}

const RateSpec* find_rate_spec(const std::string& name) {
  return find_named(rate_specs(), name);
}

RateSpec rate_spec(const std::string& name) {
  const RateSpec* spec = find_rate_spec(name);
  return spec != nullptr ? *spec : RateSpec{.name = name};
}

std::string rate_text(const std::string& rate, double value) {
  return fixed_text(value, rate_spec(rate).decimals);
}

bool is_truth_count(const std::string& name) {
  const CountSpec* spec = find_named(protocol_registry().counts, name);
  return spec != nullptr && spec->of_truth;
}

}  // namespace raymoval
