// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval::pose_formats {

/// A line that is neither empty nor a comment.
struct TextRow {
  std::size_t line = 0;  ///< Counted from 1.
  std::string_view text;
  std::vector<std::string_view> words;
};

/// A text with a row of words a line, between blanks, commas or semicolons.
class PoseText {
 public:
  PoseText(std::filesystem::path path, std::string content);
  PoseText(const PoseText&) = delete;
  PoseText& operator=(const PoseText&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// What stands between the words of the first row: ' ', ',' or ';'.
  [[nodiscard]] char separator() const { return separator_; }
  /// The names above the columns, as they are written: of a first line without numbers, or of the
  /// last comment above the numbers. It is empty if there is no such line.
  [[nodiscard]] const std::vector<std::string_view>& names() const { return names_; }
  /// Whether the names stand in a line of their own, which is no comment.
  [[nodiscard]] bool has_header() const { return header_line_ > 0; }
  /// The first row of numbers; no words if there is none.
  [[nodiscard]] const TextRow& first() const { return first_; }
  /// "poses.txt: line 12".
  [[nodiscard]] std::string place(std::size_t line) const;

  /// Calls `visit(TextRow)` for each row of numbers.
  template <class Visit>
  void for_each_row(Visit&& visit) const {
    std::size_t number = 0;
    TextRow row;
    for (std::size_t at = 0; at < content_.size();) {
      const std::size_t end = std::min(content_.find('\n', at), content_.size());
      row.text = std::string_view(content_).substr(at, end - at);
      at = end + 1;
      row.line = ++number;
      if (number == header_line_ || is_blank_or_comment(row.text)) continue;
      split_words(row.text, row.words);
      visit(row);
    }
  }

  /// Word `word` of `row` as a number.
  /// @throws DataError with file, line and column if it is none
  [[nodiscard]] double number(const TextRow& row, std::size_t word) const;
  /// All words of `row` as numbers.
  [[nodiscard]] std::vector<double> numbers(const TextRow& row) const;

 private:
  static bool is_blank_or_comment(std::string_view line);
  void split_words(std::string_view line, std::vector<std::string_view>& words) const;
  void look_at_head();

  std::filesystem::path path_;
  std::string content_;
  char separator_ = ' ';
  std::vector<std::string_view> names_;
  std::size_t header_line_ = 0;
  TextRow first_;
};

}  // namespace raymoval::pose_formats
