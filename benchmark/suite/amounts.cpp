// SPDX-License-Identifier: MIT
#include "benchmark/suite/amounts.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Names of units in small letters, each with the factor to the option's unit.
using Units = std::vector<std::pair<std::string, double>>;

std::string small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

/// The amount in `text`, in the option's unit, which is also the unit of a plain number. No value
/// if `text` is not a number with or without a unit, or not greater than 0.
std::optional<double> parse_amount(const std::string& text, const Units& units) {
  std::size_t end = text.size();
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  while (end > 0 && letter(text[end - 1])) --end;
  const std::string unit = small_letters(text.substr(end));
  std::string digits = text.substr(0, end);
  while (!digits.empty() && digits.back() == ' ') digits.pop_back();
  const auto number = parse_number<double>(digits);
  if (!number || !(*number > 0.0) || *number > 1e12) return std::nullopt;
  if (unit.empty()) return *number;
  for (const auto& [name, factor] : units) {
    if (name == unit) return *number * factor;
  }
  return std::nullopt;
}

}  // namespace

double parse_memory_mib(const std::string& option, const std::string& text) {
  constexpr double kMib = 1024.0 * 1024.0;
  static const Units units = {{"k", 1.0 / 1024.0},
                              {"kib", 1.0 / 1024.0},
                              {"kb", 1e3 / kMib},
                              {"m", 1.0},
                              {"mib", 1.0},
                              {"mb", 1e6 / kMib},
                              {"g", 1024.0},
                              {"gib", 1024.0},
                              {"gb", 1e9 / kMib},
                              {"t", 1024.0 * 1024.0},
                              {"tib", 1024.0 * 1024.0},
                              {"tb", 1e12 / kMib}};
  if (const auto mib = parse_amount(text, units)) return *mib;
  throw UsageError(option + " " + text +
                   ": expected a number greater than 0 in MiB, or one with a unit, such as 2000, "
                   "500MB, 2GB or 2GiB.");
}

double parse_seconds(const std::string& option, const std::string& text) {
  static const Units units = {{"s", 1.0},    {"sec", 1.0},     {"second", 1.0},   {"seconds", 1.0},
                              {"m", 60.0},   {"min", 60.0},    {"minute", 60.0},  {"minutes", 60.0},
                              {"h", 3600.0}, {"hour", 3600.0}, {"hours", 3600.0}, {"d", 86400.0}};
  if (const auto seconds = parse_amount(text, units)) return *seconds;
  throw UsageError(option + " " + text +
                   ": expected a number greater than 0 in seconds, or one with a unit, such as 90, "
                   "90s, 5min or 2h.");
}

double parse_positive(const std::string& option, const std::string& text) {
  const auto value = parse_number<double>(text);
  if (value && *value > 0.0 && *value < 1e6) return *value;
  throw UsageError(option + " " + text +
                   ": expected a number greater than 0 and less than 1,000,000, without a unit.");
}

int parse_whole(const std::string& option, const std::string& text, int low, int high,
                const std::string& what, const std::string& example) {
  const auto value = parse_number<int>(text);
  if (value && *value >= low && *value <= high) return *value;
  throw UsageError(option + " " + text + ": expected " + what + " from " + std::to_string(low) +
                   " to " + std::to_string(high) + example + ".");
}

RangeLimits parse_range(const std::string& option, const std::string& text) {
  const std::string form = ": expected MIN:MAX in metres, such as 2.7:50";
  const auto parts = split(text, ':');
  RangeLimits limits;
  std::optional<double> values[2];
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    const auto value = parse_number<double>(parts[i]);
    if (!value || !(*value >= 0.0) || i > 1) {
      throw UsageError(option + " " + text + form + ", or :50 for at most 50 m.");
    }
    values[i] = *value;
  }
  if (parts.size() == 1 && values[0]) {
    const std::string number(parts[0]);
    throw UsageError(option + " " + text + form + ". Write :" + number + " for at most " + number +
                     " m, or " + number + ": for at least that.");
  }
  if (values[0]) limits.min = *values[0];
  if (values[1]) limits.max = *values[1];
  if (parts.size() != 2 || !(limits.max > limits.min)) {
    const bool swapped = values[0] && values[1] && *values[0] > *values[1];
    throw UsageError(option + " " + text + form + "." +
                     (swapped ? " MIN comes first: write " + std::string(parts[1]) + ":" +
                                    std::string(parts[0]) + "."
                              : ""));
  }
  return limits;
}

}  // namespace raymoval
