// SPDX-License-Identifier: MIT
#include "benchmark/result/checks/differences.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmark/result/result_fields.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

/// The first part of `wanted` that differs in `stored`. @param what precedes its name
std::string first_change(const std::string& what, const ordered_json& stored,
                         const ordered_json& wanted) {
  for (const auto& [key, value] : wanted.items()) {
    const std::string name = what.empty() ? key : what + " " + key;
    if (!stored.contains(key)) return name + " is new";
    if (value.is_object() && stored[key].is_object()) {
      const std::string inner = first_change(name, stored[key], value);
      if (!inner.empty()) return inner;
    } else if (stored[key] != value) {
      return fmt::format("{} was {}, is {}", name, stored[key].dump(), value.dump());
    }
  }
  return "";
}

/// Like first_change, but a part that only `stored` has is a difference too.
std::string record_difference(const std::string& what, const ordered_json& stored,
                              const ordered_json& wanted) {
  const std::string change = first_change(what, stored, wanted);
  if (!change.empty()) return change;
  for (const auto& [key, value] : stored.items()) {
    if (!wanted.contains(key)) return (what.empty() ? key : what + " " + key) + " was removed";
  }
  return "";
}

void add_facts(const std::string& prefix, const Configuration& configuration, Facts& facts) {
  for (const auto& [name, value] : configuration) facts[prefix + name] = value_text(value);
}

}  // namespace

std::string identity_difference(const Cell& stored, const CellIdentity& wanted) {
  // Differences that a reader understands come before hashes.
  std::string found = record_difference("parameter", to_json(stored.method.parameters),
                                        to_json(wanted.method.parameters));
  if (found.empty()) {
    found = record_difference("method", to_json(stored.method), to_json(wanted.method));
  }
  if (found.empty()) found = protocol_difference(protocols_of(stored), wanted.protocols);
  if (found.empty()) {
    const DataRecord data = stored.data.value_or(DataRecord{});
    found = record_difference("data", to_json(data), to_json(wanted.data));
  }
  if (!found.empty()) return found;
  if (!stored.columns) return "columns is new";
  if (stored.columns->version != kColumnsVersion) {
    return fmt::format("columns version was {}, is {}", value_text(stored.columns->version),
                       value_text(kColumnsVersion));
  }
  return "it was made with other settings";
}

std::string method_difference(const MethodRecord& stored, const SuiteMethodRecord& wanted) {
  const std::string found =
      record_difference("parameter", to_json(stored.parameters), to_json(wanted.parameters));
  if (!found.empty() || stored.version == wanted.version) return found;
  return fmt::format("method version was {}, is {}", value_text(stored.version),
                     value_text(wanted.version));
}

std::string data_difference(const DataRecord& stored, const DataRecord& wanted) {
  return record_difference("", to_json(stored), to_json(wanted));
}

std::string protocol_difference(const std::vector<ProtocolRecord>& stored,
                                const std::vector<ProtocolRecord>& wanted) {
  for (const ProtocolRecord& protocol : wanted) {
    const ProtocolRecord* known = find_named(stored, protocol.name);
    const std::string what = "protocol " + protocol.name;
    if (known == nullptr) return what + " is new";
    const std::string inner = record_difference(what, to_json(*known), to_json(protocol));
    if (!inner.empty()) return inner;
  }
  for (const ProtocolRecord& protocol : stored) {
    if (find_named(wanted, protocol.name) == nullptr) {
      return "protocol " + protocol.name + " is no longer requested";
    }
  }
  return "";
}

std::vector<ProtocolRecord> protocols_of(const Cell& cell) {
  std::vector<ProtocolRecord> protocols;
  for (const Score& score : cell.scores) protocols.push_back(score.protocol);
  return protocols;
}

Facts comparison_facts(const Cell& cell) {
  Facts facts;
  add_facts("parameter ", cell.method.parameters, facts);
  facts["method"] = value_text(cell.method.name);
  facts["variant"] = value_text(cell.method.variant);
  if (!cell.data) return facts;  // The data could not be read.
  const ordered_json data = to_json(*cell.data);
  // Frames, poses and sensor are part of the fingerprint; here they show why it differs.
  for (const char* part :
       {"fingerprint", "scans", "frames", "poses", "sensor", "range_m", "label_rule", "drop_ego",
        "T_sensor", "sensor_origin", "time_offset_s", "deskew"}) {
    if (data.contains(part)) facts[std::string("data ") + part] = data[part].dump();
  }
  if (!cell.data->up.empty() && cell.data->up != "z") facts["data up"] = cell.data->up;
  return facts;
}

Facts comparison_facts(const Score& score) {
  Facts facts;
  add_facts("option ", score.protocol.options, facts);
  facts["protocol"] = value_text(score.protocol.protocol);
  facts["protocol version"] = value_text(score.protocol.version);
  return facts;
}

}  // namespace raymoval
