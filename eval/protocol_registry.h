// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "eval/protocol.h"

namespace raymoval {

/// Marks a name as that of a protocol, since `erasor` is the name of a method too.
inline constexpr std::string_view kProtocolPrefix = "protocol:";

/// "erasor" of "protocol:erasor", and of "erasor".
inline std::string without_protocol_prefix(const std::string& name) {
  return name.substr(name.starts_with(kProtocolPrefix) ? kProtocolPrefix.size() : 0);
}

// The protocols of the program: the built-in ones, then the ones that a program or a test
// registers. All code that shows, compares or checks a rate reads its definition here.

const std::deque<ProtocolEntry>& protocol_entries();

/// The protocol called `name`; null if there is none.
const ProtocolEntry* find_protocol(const std::string& name);

/// The same. @throws UsageError suggesting the nearest name if there is none
const ProtocolEntry& protocol_entry(const std::string& name);

/// The name of the default protocol.
const std::string& default_protocol();

/// Options of the protocol called `name` at their defaults. @throws UsageError as `protocol_entry`
Configuration protocol_defaults(const std::string& name);

/// @throws UsageError as `protocol_entry`, ConfigurationError for an unknown option
std::unique_ptr<Protocol> make_protocol(const std::string& name, const Configuration& options);

/// Adds a protocol of a program's own, for instance at the beginning of its main function.
/// @throws ConfigurationError if the name is taken, if a rate follows from one that the protocol
/// does not have, or if another protocol defines a rate or count of the same name differently
/// @note No other thread may use the registry meanwhile.
void register_protocol(ProtocolEntry entry);

/// Takes a registered protocol away again, as a test does at its end.
void unregister_protocol(const std::string& name);

/// The rates of all protocols, in the order of the protocols.
const std::vector<RateSpec>& rate_specs();

/// The definition of the rate called `name`; null if no protocol has such a rate.
const RateSpec* find_rate_spec(const std::string& name);

/// The definition of the rate called `name`. A rate that no protocol has is secondary and in
/// percent, and `find_rate_spec` does not find it: its better direction is unknown.
RateSpec rate_spec(const std::string& name);

/// A rate as it is displayed: "98.123", F1 "0.9812".
std::string rate_text(const std::string& rate, double value);

/// Whether a count called `name` follows from scans and labels, so that no mask can change it. A
/// count that no protocol has does not.
bool is_truth_count(const std::string& name);

}  // namespace raymoval
