// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// A value of a YAML text in the form that rosbag2 writes: maps and lists by indentation, and plain
/// or quoted values. There are no anchors, so a text never gives more than it holds. What is in
/// brackets of one line is a list of values.
struct YamlNode {
  std::string key;                 ///< Empty in a list.
  std::string value;               ///< What stands behind the key, without quotes.
  std::size_t begin = 0, end = 0;  ///< Where that stands in the text, with quotes.
  int line = 0;                    ///< From 1 on.
  std::vector<YamlNode> children;

  /// The child with this key, or null.
  [[nodiscard]] const YamlNode* find(std::string_view wanted) const;
};

/// @param where begins messages, such as "metadata.yaml"
/// @throws DataError naming the line that is not of this form, or more than 32 levels
YamlNode parse_block_yaml(std::string_view text, const std::string& where);

}  // namespace raymoval
