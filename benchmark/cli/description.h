// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/protocol.h"
#include "methods/registry.h"

namespace raymoval {

/// What `raymoval describe` says, independent of how it is written.
struct Description {
  std::string name;
  std::string sentence;
  std::string source;
  std::string version;
  std::vector<std::string> notes;
  std::vector<MethodVariant> variants;
  std::vector<ParameterSpec> parameters;  ///< Defaults are those of the variant described.
  /// Whether each of them can change anything while the others have their defaults; all of them may
  /// where no single variant is described.
  std::vector<bool> acts = {};
  /// What a method's confidence is made of; empty: it has none. No value of a protocol.
  std::optional<std::string> confidence = std::nullopt;
};

/// A method; with a variant ("raymoval:online") its values stand as defaults.
Description describe_method(const MethodRegistry& registry, const std::string& name_and_variant);
Description describe_protocol(const ProtocolEntry& entry);

std::string description_text(const Description& description);
std::string description_markdown(const Description& description);

}  // namespace raymoval
