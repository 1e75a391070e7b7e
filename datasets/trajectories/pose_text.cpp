// SPDX-License-Identifier: MIT
#include "datasets/trajectories/pose_text.h"

#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval::pose_formats {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// A comment, or the "%time,field..." line of `rostopic echo -p`.
bool begins_comment(char c) {
  return c == '#' || c == '%';
}

bool has_letter(std::string_view word) {
  return std::any_of(word.begin(), word.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

}  // namespace

PoseText::PoseText(std::filesystem::path path, std::string content)
    : path_(std::move(path)), content_(std::move(content)) {
  look_at_head();
}

bool PoseText::is_blank_or_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(kBlanks);
  return first == std::string_view::npos || begins_comment(line[first]);
}

void PoseText::split_words(std::string_view line, std::vector<std::string_view>& words) const {
  words.clear();
  if (separator_ == ' ') {
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t first = line.find_first_not_of(kBlanks, at);
      if (first == std::string_view::npos) return;
      at = std::min(line.find_first_of(kBlanks, first), line.size());
      words.push_back(line.substr(first, at - first));
    }
    return;
  }
  line = without_blanks(line);
  if (line.ends_with(separator_)) line.remove_suffix(1);
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(separator_, at), line.size());
    words.push_back(without_blanks(line.substr(at, end - at)));
    at = end + 1;
  }
}

void PoseText::look_at_head() {
  std::string_view comment;
  std::size_t number = 0;
  for (std::size_t at = 0; at < content_.size();) {
    const std::size_t end = std::min(content_.find('\n', at), content_.size());
    const std::string_view line = without_blanks(std::string_view(content_).substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty()) continue;
    if (begins_comment(line.front())) {
      comment = without_blanks(line.substr(1));
      continue;
    }
    separator_ = separator_of(line);
    split_words(line, first_.words);
    const bool is_header = names_.empty() && first_.words.size() > 2 &&
                           std::all_of(first_.words.begin(), first_.words.end(), has_letter) &&
                           !parse_number<double>(first_.words.front());
    if (is_header && header_line_ == 0) {
      header_line_ = number;
      names_ = std::exchange(first_.words, {});
      continue;
    }
    first_.line = number;
    first_.text = line;
    if (header_line_ == 0 && !comment.empty()) split_words(comment, names_);
    return;
  }
  first_ = {};
}

std::string PoseText::place(std::size_t line) const {
  return path_.string() + ": line " + std::to_string(line);
}

double PoseText::number(const TextRow& row, std::size_t word) const {
  const std::string_view text = row.words[word];
  if (const auto value = parse_number<double>(text)) return *value;
  const auto column = static_cast<std::size_t>(text.data() - row.text.data()) + 1;
  // "1,5 0 0": decimal commas are taken for what stands between the numbers.
  const bool blanks_inside = separator_ == ',' && text.find(' ') != std::string_view::npos;
  throw DataError(place(row.line) + ", column " + std::to_string(column) + ": '" +
                  std::string(text.substr(0, 40)) + "' is not a number; expected numbers between " +
                  (separator_ == ' '   ? "blanks."
                   : separator_ == ',' ? "commas."
                                       : "semicolons.") +
                  (blanks_inside ? " If the commas are decimal ones, write points." : ""));
}

std::vector<double> PoseText::numbers(const TextRow& row) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < row.words.size(); ++i) all.push_back(number(row, i));
  return all;
}

}  // namespace raymoval::pose_formats
