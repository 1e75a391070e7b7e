// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace raymoval {

/// Lists and objects inside one another go no deeper; what walks a value may recurse.
inline constexpr int kMostJsonDepth = 64;

/// `text` as JSON with // and /* */ comments.
/// @param where begins the message, such as the file's path
/// @throws ConfigurationError with line, column and reason for what is no JSON, for a number beyond
///   double, a key that stands twice in an object, a text with a zero byte, and more than
///   `kMostJsonDepth` levels
nlohmann::json parse_json(const std::string& text, const std::string& where);

/// The same with the order of keys kept; what a program printed may stand in it, zero bytes too.
nlohmann::ordered_json parse_ordered_json(const std::string& text, const std::string& where);

}  // namespace raymoval
