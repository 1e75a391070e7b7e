// SPDX-License-Identifier: MIT
#include "eval/protocol.h"

#include <functional>

#include "core/text.h"
#include "eval/dynamicmap/dynamicmap.h"
#include "eval/dynamicmap/strict.h"
#include "eval/erasor/erasor.h"

namespace raymoval {
namespace {

struct Maker {
  ProtocolEntry entry;
  std::function<std::unique_ptr<Protocol>(const Configuration&)> make;
};

const std::vector<Maker>& makers() {
  static const std::vector<Maker> all = {
      {erasor_protocol_entry(), make_erasor_protocol},
      {dynamicmap_protocol_entry(), make_dynamicmap_protocol},
      {strict_protocol_entry(), make_strict_protocol},
  };
  return all;
}

const Maker& find_maker(const std::string& name) {
  std::vector<std::string> names;
  for (const Maker& maker : makers()) {
    if (maker.entry.name == name) return maker;
    names.push_back(maker.entry.name);
  }
  throw UsageError("protocol '" + name + "' is unknown." + suggestion(name, names));
}

}  // namespace

Rate percent_rate(const std::string& name, std::int64_t part, std::int64_t whole,
                  const std::string& reason) {
  if (whole == 0) return {name, std::nullopt, reason};
  return {name, 100.0 * static_cast<double>(part) / static_cast<double>(whole)};
}

std::int64_t ProtocolResult::count(const std::string& name) const {
  for (const auto& [key, value] : counts) {
    if (key == name) return value;
  }
  throw InternalError("protocol '" + protocol + "' has no count '" + name + "'");
}

std::optional<double> ProtocolResult::rate(const std::string& name) const {
  for (const Rate& rate : rates) {
    if (rate.name == name) return rate.value;
  }
  return std::nullopt;
}

const std::vector<ProtocolEntry>& protocol_entries() {
  static const std::vector<ProtocolEntry> entries = [] {
    std::vector<ProtocolEntry> list;
    for (const Maker& maker : makers()) list.push_back(maker.entry);
    return list;
  }();
  return entries;
}

const ProtocolEntry& protocol_entry(const std::string& name) {
  return find_maker(name).entry;
}

Configuration protocol_defaults(const std::string& name) {
  Configuration options;
  for (const ParameterSpec& spec : find_maker(name).entry.parameters) {
    options.emplace_back(spec.name, spec.default_value);
  }
  return options;
}

std::unique_ptr<Protocol> make_protocol(const std::string& name, const Configuration& options) {
  const Maker& maker = find_maker(name);
  for (const auto& [key, value] : options) {
    find_parameter("protocol " + name, maker.entry.parameters, key);
  }
  return maker.make(options);
}

}  // namespace raymoval
