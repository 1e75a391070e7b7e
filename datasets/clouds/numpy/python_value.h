// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raymoval {

/// A value of the head of an .npy file, which is a Python literal: text, whole number, True, False,
/// None, tuple, list, dictionary.
struct PythonValue {
  enum class Kind { kText, kNumber, kTrue, kFalse, kNone, kTuple, kList, kDictionary };
  Kind kind = Kind::kNone;
  std::string text;                ///< Of kText, escapes resolved.
  std::uint64_t number = 0;        ///< Of kNumber, from 0.
  std::vector<PythonValue> items;  ///< Of kTuple and kList; of kDictionary key, value, key, ...

  [[nodiscard]] bool is(Kind other) const { return kind == other; }
  /// The value of the key `name` of a dictionary, or null.
  [[nodiscard]] const PythonValue* find(std::string_view name) const;
};

/// Reads the whole of `text`. Nothing is executed; values stand at most 16 deep in one another.
/// @param where begins the message
/// @throws DataError naming the column of what is no such literal
PythonValue parse_python_value(std::string_view text, const std::string& where);

}  // namespace raymoval
