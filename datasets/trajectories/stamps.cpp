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

/// A decimal number: `digits` with the point behind the first `point` digits.
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

/// Whether `stamp` is from 1973 to 2109.
bool is_since_1970(Nanoseconds stamp) {
  return stamp > 100'000'000'000'000'000 && stamp < kMostStamp;
}

/// A time as a double: 0 for a word that is no time, and for a time that is nearer to 0 than any
/// double, such as 1e-400.
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

/// A time in a name: its seconds, and the digits behind the mark that follows them.
struct NameTime {
  std::string_view seconds, part;
  bool since_1970 = true;
  bool marked = true;  ///< Whether there is a mark between the two.
};

std::string_view digits_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  return text.substr(at, end - at);
}

/// The time that begins with the digits `run` at position `at` of `stem`.
std::optional<NameTime> time_at(std::string_view stem, std::size_t at, std::string_view run) {
  constexpr std::size_t kSeconds = 10;
  const std::string_view seconds = run.substr(0, kSeconds);
  const auto whole = parse_stamp(seconds, TimeUnit::kSeconds);
  if (run.size() < kSeconds - 1 || !whole || !is_since_1970(*whole)) return std::nullopt;
  if (run.size() > kSeconds) {
    const bool usual = run.size() == 13 || run.size() == 16 || run.size() == 19;
    return usual ? std::optional(NameTime{seconds, run.substr(kSeconds), true, false})
                 : std::nullopt;
  }
  const std::size_t mark = at + run.size();
  const bool marked =
      mark < stem.size() && std::string_view("._-").find(stem[mark]) != std::string_view::npos;
  const std::string_view part = marked ? digits_at(stem, mark + 1) : std::string_view{};
  if (part.empty() && run.size() < kSeconds) return std::nullopt;
  return NameTime{seconds, part};
}

std::optional<NameTime> time_in_name(std::string_view stem) {
  for (std::size_t at = 0; at < stem.size();) {
    const std::string_view run = digits_at(stem, at);
    if (const auto time = time_at(stem, at, run)) return time;
    at += std::max<std::size_t>(run.size(), 1);
  }
  const std::string_view whole = digits_at(stem, 0);
  if (whole.empty() || whole.size() >= stem.size() || stem[whole.size()] != '.') {
    return std::nullopt;
  }
  const std::string_view part = stem.substr(whole.size() + 1);
  if (part.empty() || !all_digits(part)) return std::nullopt;
  return NameTime{whole, part, false};
}

/// The date and time that begins at `rest`, such as "2014_11_10_11_32_17.25" or
/// "20141110T113217"; any mark, or none, may separate its parts.
std::optional<Nanoseconds> date_at(std::string_view rest) {
  constexpr std::string_view kDateForm = "dddd-dd-dd dd:dd:dd";
  std::string date;
  for (const char part : kDateForm) {
    const bool has_digit = !rest.empty() && is_digit(rest.front());
    if (part == 'd' && !has_digit) return std::nullopt;
    date += part == 'd' ? rest.front() : part;
    const bool mark = part != 'd' && !rest.empty() &&
                      std::string_view("-_.: T").find(rest.front()) != std::string_view::npos;
    if (part == 'd' || mark) rest.remove_prefix(1);
  }
  const char mark = rest.empty() ? '\0' : rest.front();
  std::string_view decimals = digits_at(rest, rest.empty() || is_digit(mark) ? 0 : 1);
  if (mark != '.' && decimals.size() % 3 != 0) decimals = {};
  return parse_date(decimals.empty() ? date : date + "." + std::string(decimals));
}

/// A way to read the digits behind the seconds.
struct NameReading {
  int digits = 0;  ///< They count 10^-digits s each, without leading zeros; 0: they are decimals.
  std::vector<Nanoseconds> stamps = {};
  double cost = 0.0;
};

/// The ways in which the digits behind the seconds can be read. A number of varying length has no
/// leading zeros, and decimals of varying length have no trailing ones.
std::vector<NameReading> name_readings(const std::vector<NameTime>& times) {
  std::size_t longest = 0, shortest = std::string_view::npos;
  bool leading = false, trailing = false, unmarked = false;
  for (const NameTime& time : times) {
    longest = std::max(longest, time.part.size());
    shortest = std::min(shortest, time.part.size());
    leading = leading || (time.part.size() > 1 && time.part.starts_with('0'));
    trailing = trailing || (time.part.size() > 1 && time.part.ends_with('0'));
    unmarked = unmarked || !time.marked || !time.since_1970;
  }
  std::vector<NameReading> readings;
  if (longest == shortest || !trailing) readings.push_back({0});
  for (const int digits : {3, 6, kNanosecondDigits}) {
    if (longest > static_cast<std::size_t>(digits)) continue;
    if (longest != shortest && !leading && !unmarked) readings.push_back({digits});
    break;
  }
  return readings;
}

std::optional<Nanoseconds> stamp_of(const NameTime& time, int digits) {
  if (digits == 0) {
    return parse_stamp(std::string(time.seconds) + "." + std::string(time.part),
                       TimeUnit::kSeconds);
  }
  const auto whole = parse_stamp(time.seconds, TimeUnit::kSeconds);
  const auto part =
      time.part.empty() ? Nanoseconds{0} : parse_stamp(time.part, static_cast<TimeUnit>(digits));
  if (!whole || !part) return std::nullopt;
  return *whole + *part;
}

/// Fills in the cost of a reading: the share outside `span`, and the unevenness of the spacing.
/// @return false if two times are equal, or nearer than for any sensor
bool is_plausible(NameReading& reading,
                  const std::optional<std::pair<Nanoseconds, Nanoseconds>>& span) {
  constexpr double kLeastSpacing = 5e6;  // Nanoseconds.
  double outside = 0.0;
  for (const Nanoseconds stamp : reading.stamps) {
    if (span && (stamp < span->first || stamp > span->second)) outside += 1.0;
  }
  std::vector<Nanoseconds> sorted = reading.stamps;
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] == sorted[i - 1]) return false;
    gaps.push_back(static_cast<double>(sorted[i] - sorted[i - 1]));
  }
  reading.cost = outside / static_cast<double>(sorted.size());
  if (gaps.empty()) return true;
  const double usual = median(gaps);
  double uneven = 0.0;
  for (const double gap : gaps) uneven += std::abs(gap - usual) / usual;
  reading.cost += std::min(1.0, uneven / static_cast<double>(gaps.size()));
  return usual >= kLeastSpacing;
}

/// Fills in the times of a reading, and their cost. @return false if it is not plausible
bool read_names(const std::vector<NameTime>& times,
                const std::optional<std::pair<Nanoseconds, Nanoseconds>>& span,
                NameReading& reading) {
  for (const NameTime& time : times) {
    const auto stamp = stamp_of(time, reading.digits);
    if (!stamp) return false;
    reading.stamps.push_back(*stamp);
  }
  return is_plausible(reading, span);
}

/// The dates in the names of several scans; empty unless each has one. In
/// "20141110_113217_000123" the last number is that of a scan.
std::optional<NameStamps> dates_in_names(const std::vector<std::string>& stems) {
  NameReading reading;
  for (const std::string& stem : stems) {
    std::optional<Nanoseconds> date;
    for (std::size_t at = 0; at < stem.size() && !date; ++at) {
      if (at == 0 || !is_digit(stem[at - 1])) date = date_at(std::string_view(stem).substr(at));
    }
    if (!date) return std::nullopt;
    reading.stamps.push_back(*date);
  }
  if (stems.size() < 2 || !is_plausible(reading, std::nullopt)) return std::nullopt;
  return NameStamps{std::move(reading.stamps), true, ""};
}

}  // namespace

std::optional<Nanoseconds> parse_stamp(std::string_view text) {
  return parse_stamp(text, TimeUnit::kSeconds);
}

namespace {

/// Removes "Z", "+01:00" or "-0530" from the end of a time of day. @return the shift, nanoseconds
Nanoseconds take_time_zone(std::string_view& text) {
  if (text.ends_with('Z')) text.remove_suffix(1);
  const std::size_t sign = text.find_first_of("+-");
  if (sign == std::string_view::npos) return 0;
  std::string digits(text.substr(sign + 1));
  std::erase(digits, ':');
  const auto value =
      all_digits(digits) && digits.size() == 4 ? parse_number<int>(digits) : std::nullopt;
  if (!value) return 0;  // The sign is kept, so that this is no time.
  const Nanoseconds shift = (*value / 100 * 60 + *value % 100) * 60'000'000'000;
  const bool negative = text[sign] == '-';
  text = text.substr(0, sign);
  return negative ? -shift : shift;
}

}  // namespace

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
  std::string_view rest = text.substr(17);
  const Nanoseconds zone = take_time_zone(rest);
  const auto seconds = parse_stamp(rest, TimeUnit::kSeconds);
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!seconds || *seconds < 0 || *seconds >= 61'000'000'000 || !date.ok()) return std::nullopt;
  if (*year < 1900 || *year > 2100) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((static_cast<Nanoseconds>(days) * 24 + *hour) * 60 + *minute) * 60'000'000'000 +
         *seconds - zone;
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

namespace {

StampColumn parse_dates(const std::vector<std::string_view>& words,
                        const std::function<std::string(std::size_t)>& place) {
  StampColumn column;
  column.unit = TimeUnit::kNanoseconds;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto date = parse_date(words[i]);
    if (!date) {
      throw DataError(place(i) + ": '" + std::string(words[i].substr(0, 40)) +
                      "' is not a date as in the lines above; expected one such as 2011-09-26 "
                      "13:02:25.964389445.");
    }
    column.stamps.push_back(*date);
  }
  return column;
}

}  // namespace

StampColumn parse_stamps(const std::vector<std::string_view>& words, std::optional<TimeUnit> unit,
                         const std::function<std::string(std::size_t)>& place) {
  constexpr std::size_t kEnough = 1000;  // To see the usual spacing.
  std::vector<double> rough, steps;
  for (std::size_t i = 0; i < std::min(words.size(), kEnough); ++i) {
    rough.push_back(rough_number(words[i]));
    if (i > 0) steps.push_back(std::abs(rough[i] - rough[i - 1]));
  }
  StampColumn column;
  if (!words.empty() && parse_date(words.front())) return parse_dates(words, place);
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

std::optional<NameStamps> stamps_in_names(
    const std::vector<std::string>& stems,
    const std::optional<std::pair<Nanoseconds, Nanoseconds>>& span) {
  std::vector<NameTime> times;
  for (const std::string& stem : stems) {
    const auto time = time_in_name(stem);
    const bool same = time && (times.empty() || time->since_1970 == times.front().since_1970);
    if (!same) return dates_in_names(stems);
    times.push_back(*time);
  }
  if (times.empty()) return std::nullopt;
  // A single "1.10" may be a version.
  const bool sure = times.front().since_1970 || times.size() > 1 ||
                    times.front().part.size() == static_cast<std::size_t>(kNanosecondDigits);
  if (!sure) return std::nullopt;
  std::vector<NameReading> readings;
  for (NameReading reading : name_readings(times)) {
    if (read_names(times, span, reading)) readings.push_back(std::move(reading));
  }
  if (readings.empty()) return std::nullopt;
  const auto best = std::min_element(readings.begin(), readings.end(),
                                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
  NameStamps found{std::move(best->stamps), times.front().since_1970, ""};
  if (readings.size() == 1) return found;
  found.note = "the digits behind the seconds in the names of the scans are read as " +
               (best->digits == 0 ? std::string("decimals")
                                  : std::string("a number of ") +
                                        time_unit_name(static_cast<TimeUnit>(best->digits))) +
               ", by how evenly the scans then follow each other.";
  return found;
}

StampColumn read_stamp_file(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  const std::vector<std::string_view> lines = content_lines(text);
  const auto place = [&](std::size_t i) {
    const auto above = std::count(text.data(), lines[i].data(), '\n');
    return path.string() + ": line " + std::to_string(above + 1);
  };
  StampColumn column = parse_stamps(lines, std::nullopt, place);
  const bool numbers = lines.empty() || !parse_date(lines.front());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool seconds = numbers && column.unit == TimeUnit::kSeconds;
    column.since_first.push_back(seconds ? rough_number(lines[i]) - rough_number(lines.front())
                                         : to_seconds(column.stamps[i] - column.stamps.front()));
  }
  return column;
}

}  // namespace raymoval
