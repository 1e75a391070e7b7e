// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace raymoval {

/// The greatest depth of nested lists and objects. Code that visits a value may recurse.
inline constexpr int kMostJsonDepth = 64;

/// `text` as JSON with // and /* */ comments.
/// @param where begins the message, such as the file's path
/// @throws ConfigurationError with line, column and reason for text that is no JSON, for a number
/// beyond double, a key that occurs twice in an object, a text with a zero byte, and more than
///   `kMostJsonDepth` levels
nlohmann::json parse_json(const std::string& text, const std::string& where);

/// The same with the order of keys kept. Texts may have zero bytes, because they may quote the
/// output of a program.
nlohmann::ordered_json parse_ordered_json(const std::string& text, const std::string& where);

}  // namespace raymoval
