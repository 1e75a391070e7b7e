// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// Shortest text that reads back as exactly `value`; never depends on the locale.
std::string number_text(double value);

/// As number_text, but whole numbers up to a billion without exponent: 100000, not 1e+05.
std::string plain_number_text(double value);

/// `value` with `decimals` digits after the point, rounded to nearest; locale independent.
std::string fixed_text(double value, int decimals);

/// 0.4567 -> "46 %", or "45.7 %" with one decimal.
std::string percent_text(double share, int decimals = 0);

/// 1234567 -> "1,234,567".
std::string grouped_text(std::uint64_t value);

/// "1 scan", "2,000 scans".
std::string counted_text(std::uint64_t count, const std::string& noun);

/// The whole of `text` read as a number (a leading '+' is allowed); nothing if any character is
/// left over or the value does not fit.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The numbers between each `separator`; nothing if a piece is no finite number.
std::optional<std::vector<double>> parse_numbers(std::string_view text, char separator);

inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
/// Whether each character is a digit; true for an empty text.
inline bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), is_digit);
}

/// `text` with the letters A to Z in lower case.
std::string in_lower_case(std::string text);

/// Pieces of `text` between blanks and tabs (also carriage returns); empty pieces are dropped.
std::vector<std::string_view> split_blanks(std::string_view text);

/// Pieces of `text` between each `separator`; empty pieces are kept.
std::vector<std::string_view> split(std::string_view text, char separator);

/// "a, b, c".
std::string join(const std::vector<std::string>& parts, std::string_view separator = ", ");

/// The candidate with the smallest edit distance to `name` (a swap of neighbours is one change), or
/// nothing if none is near: more than one letter and more than a third of the longer name would
/// have to change, and neither contains the other.
std::optional<std::string> closest_name(std::string_view name,
                                        const std::vector<std::string>& candidates);

/// " Did you mean 'x'?" or, with no near candidate, " Supported are: a, b.".
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace raymoval
