// SPDX-License-Identifier: MIT
#include "datasets/trajectories/stamps.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr int kNanosecondDigits = 9;

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// A decimal number: `digits` with the point behind the first `point` of them.
struct Decimal {
  bool negative = false;
  std::string digits;
  long point = 0;
};

std::optional<Decimal> parse_decimal(std::string_view text) {
  constexpr long kMostExponent = 1000;
  constexpr std::size_t kMostDigits = 1000;
  Decimal decimal;
  decimal.negative = text.starts_with('-');
  if (decimal.negative || text.starts_with('+')) text.remove_prefix(1);
  const std::size_t e = text.find_first_of("eE");
  long exponent = 0;
  if (e != std::string_view::npos) {
    const auto number = parse_number<long>(text.substr(e + 1));
    if (!number || std::abs(*number) > kMostExponent) return std::nullopt;
    exponent = *number;
    text = text.substr(0, e);
  }
  const std::size_t point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  const std::string_view part = point == std::string_view::npos ? "" : text.substr(point + 1);
  if (!all_digits(whole) || !all_digits(part) || (whole.empty() && part.empty())) {
    return std::nullopt;
  }
  if (whole.size() + part.size() > kMostDigits) return std::nullopt;
  decimal.digits = std::string(whole) + std::string(part);
  decimal.point = static_cast<long>(whole.size()) + exponent;
  return decimal;
}

/// `decimal` times ten to the power of `shift`, rounded to a whole number.
std::optional<Nanoseconds> whole_number(const Decimal& decimal, int shift) {
  const long point = decimal.point + shift;
  Nanoseconds value = 0;
  for (long i = 0; i < point; ++i) {
    const bool there = i < static_cast<long>(decimal.digits.size());
    const int digit = there ? decimal.digits[static_cast<std::size_t>(i)] - '0' : 0;
    if (value > kMostStamp / 10) return std::nullopt;
    value = 10 * value + digit;
    if (value == 0 && !there) break;  // Zero, however large the exponent.
  }
  const bool has_next = point >= 0 && point < static_cast<long>(decimal.digits.size());
  if (has_next && decimal.digits[static_cast<std::size_t>(point)] >= '5') ++value;
  if (value > kMostStamp) return std::nullopt;
  return decimal.negative ? -value : value;
}

/// "2011-09-26 13:02:25.964389445" in UTC, or nothing.
std::optional<Nanoseconds> parse_date(std::string_view text) {
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || text[13] != ':' || text[16] != ':' ||
      (text[10] != ' ' && text[10] != 'T')) {
    return std::nullopt;
  }
  const auto part = [&](std::size_t at, std::size_t size) {
    const std::string_view digits = text.substr(at, size);
    return all_digits(digits) ? parse_number<int>(digits) : std::nullopt;
  };
  const auto year = part(0, 4), month = part(5, 2), day = part(8, 2), hour = part(11, 2),
             minute = part(14, 2);
  if (!year || !month || !day || !hour || !minute || *hour > 23 || *minute > 59) {
    return std::nullopt;
  }
  const auto seconds = parse_stamp(text.substr(17), TimeUnit::kSeconds);
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!seconds || *seconds < 0 || *seconds >= 61'000'000'000 || !date.ok()) return std::nullopt;
  if (*year < 1900 || *year > 2100) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((static_cast<Nanoseconds>(days) * 24 + *hour) * 60 + *minute) * 60'000'000'000 + *seconds;
}

/// Since 1973 and before 2109.
bool is_since_1970(Nanoseconds stamp) {
  return stamp > 100'000'000'000'000'000 && stamp < kMostStamp;
}

/// A time as a double: 0 for what is no time, and for one that is nearer to 0 than any double, such
/// as 1e-400.
double rough_number(std::string_view word) {
  return parse_number<double>(word).value_or(0.0);
}

[[noreturn]] void throw_no_stamp(std::string_view word, TimeUnit unit, const std::string& where) {
  const auto number = parse_number<double>(word);
  const std::string what = !number                   ? "is not a number"
                           : !std::isfinite(*number) ? "is not finite"
                                                     : "is more than 139 years from 1970 as " +
                                                           std::string(time_unit_name(unit));
  throw DataError(where + ": time '" + std::string(word.substr(0, 40)) + "' " + what +
                  "; expected a time in seconds, milliseconds, microseconds or nanoseconds.");
}

/// The lines of `text` without blanks at their ends; empty ones and comments are left out.
std::vector<std::string_view> content_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  lines.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    lines.push_back(line.substr(first, line.find_last_not_of(" \t\r") + 1 - first));
  }
  return lines;
}

/// @param unpadded whether what stands behind a point are nanoseconds without their leading zeros
std::optional<Nanoseconds> stamp_in_name(std::string_view stem, bool unpadded) {
  constexpr std::size_t kShortestSeconds = 9;  // In 1973.
  const std::size_t mark = stem.find_first_of("._");
  if (mark == std::string_view::npos) {
    if (!all_digits(stem) || stem.size() != kShortestSeconds + 10) return std::nullopt;
    const auto stamp = parse_stamp(stem, TimeUnit::kNanoseconds);
    return stamp && is_since_1970(*stamp) ? stamp : std::nullopt;
  }
  const std::string_view seconds = stem.substr(0, mark), part = stem.substr(mark + 1);
  if (!all_digits(seconds) || !all_digits(part) || seconds.empty() || part.empty()) {
    return std::nullopt;
  }
  const auto whole = parse_stamp(seconds, TimeUnit::kSeconds);
  const bool nine = part.size() == static_cast<std::size_t>(kNanosecondDigits);
  if (!whole || (!is_since_1970(*whole) && !(stem[mark] == '.' && nine))) return std::nullopt;
  if (stem[mark] == '.' && !unpadded) return parse_stamp(stem, TimeUnit::kSeconds);
  const auto nanoseconds = parse_stamp(part, TimeUnit::kNanoseconds);
  if (!nanoseconds || *nanoseconds >= 1'000'000'000) return std::nullopt;
  return *whole + *nanoseconds;
}

}  // namespace

std::optional<Nanoseconds> parse_stamp(std::string_view text) {
  return parse_stamp(text, TimeUnit::kSeconds);
}

const char* time_unit_name(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::kSeconds:
      return "seconds";
    case TimeUnit::kMilliseconds:
      return "milliseconds";
    case TimeUnit::kMicroseconds:
      return "microseconds";
    case TimeUnit::kNanoseconds:
      return "nanoseconds";
  }
  return "";
}

std::optional<TimeUnit> parse_time_unit(std::string_view text) {
  if (text == "s" || text == "sec" || text == "secs" || text == "seconds") {
    return TimeUnit::kSeconds;
  }
  if (text == "ms") return TimeUnit::kMilliseconds;
  if (text == "us") return TimeUnit::kMicroseconds;
  if (text == "ns" || text == "nsec" || text == "nsecs" || text == "nanosec") {
    return TimeUnit::kNanoseconds;
  }
  return std::nullopt;
}

std::optional<Nanoseconds> parse_stamp(std::string_view text, TimeUnit unit) {
  const auto decimal = parse_decimal(text);
  if (!decimal) return std::nullopt;
  return whole_number(*decimal, kNanosecondDigits - static_cast<int>(unit));
}

TimeUnit usual_time_unit(double first, double spacing) {
  constexpr double kEarliest = 1e8, kLatest = 4.4e9;     // Seconds since 1970: 1973 to 2109.
  constexpr double kLongestGap = 1e4, kUsualGap = 50.0;  // Seconds from one to the next.
  const TimeUnit units[] = {TimeUnit::kSeconds, TimeUnit::kMilliseconds, TimeUnit::kMicroseconds,
                            TimeUnit::kNanoseconds};
  for (const TimeUnit unit : units) {
    const double scale = std::pow(10.0, static_cast<int>(unit));
    const double seconds = std::abs(first) / scale;
    if (seconds >= kEarliest && seconds <= kLatest && spacing / scale <= kLongestGap) return unit;
  }
  for (const TimeUnit unit : units) {
    if (spacing / std::pow(10.0, static_cast<int>(unit)) <= kUsualGap) return unit;
  }
  return TimeUnit::kNanoseconds;
}

StampColumn parse_stamps(const std::vector<std::string_view>& words, std::optional<TimeUnit> unit,
                         const std::function<std::string(std::size_t)>& place) {
  constexpr std::size_t kEnough = 1000;  // To see the usual spacing.
  std::vector<double> rough, steps;
  for (std::size_t i = 0; i < std::min(words.size(), kEnough); ++i) {
    rough.push_back(rough_number(words[i]));
    if (i > 0) steps.push_back(std::abs(rough[i] - rough[i - 1]));
  }
  StampColumn column;
  if (!words.empty()) {
    const double spacing = steps.empty() ? 0.0 : median(std::move(steps));
    column.unit = unit.value_or(usual_time_unit(rough.front(), spacing));
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto stamp = parse_stamp(words[i], column.unit);
    if (!stamp) throw_no_stamp(words[i], column.unit, place(i));
    column.stamps.push_back(*stamp);
  }
  return column;
}

std::optional<std::vector<Nanoseconds>> stamps_in_names(const std::vector<std::string>& stems) {
  for (const bool nanoseconds : {false, true}) {
    std::vector<Nanoseconds> stamps;
    for (const std::string& stem : stems) {
      const auto stamp = stamp_in_name(stem, nanoseconds);
      if (!stamp || (!stamps.empty() && *stamp <= stamps.back())) break;
      stamps.push_back(*stamp);
    }
    if (!stems.empty() && stamps.size() == stems.size()) return stamps;
  }
  return std::nullopt;
}

StampColumn read_stamp_file(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  const std::vector<std::string_view> lines = content_lines(text);
  const auto place = [&](std::size_t i) {
    const auto above = std::count(text.data(), lines[i].data(), '\n');
    return path.string() + ": line " + std::to_string(above + 1);
  };
  StampColumn column;
  const bool numbers = lines.empty() || !parse_date(lines.front());
  if (numbers) {
    column = parse_stamps(lines, std::nullopt, place);
  } else {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto date = parse_date(lines[i]);
      if (!date) {
        throw DataError(place(i) + ": '" + std::string(lines[i].substr(0, 40)) +
                        "' is no date as in the lines above; expected one such as "
                        "2011-09-26 13:02:25.964389445.");
      }
      column.stamps.push_back(*date);
    }
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool seconds = numbers && column.unit == TimeUnit::kSeconds;
    column.since_first.push_back(seconds ? rough_number(lines[i]) - rough_number(lines.front())
                                         : to_seconds(column.stamps[i] - column.stamps.front()));
  }
  return column;
}

}  // namespace raymoval
