// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// The unit of a column of times. The value is the number of decimals of a second.
enum class TimeUnit { kSeconds = 0, kMilliseconds = 3, kMicroseconds = 6, kNanoseconds = 9 };

/// "seconds", "milliseconds" and so on.
const char* time_unit_name(TimeUnit unit);
/// The unit of "s", "sec", "ms", "us" or "ns"; empty for other texts.
std::optional<TimeUnit> parse_time_unit(std::string_view text);

/// "1317384506400000100" (with `unit` nanoseconds) or "1.3173845064e+09" as nanoseconds, exactly,
/// without a double. Digits beyond nanoseconds are rounded.
/// @return empty if it is no number, or beyond `kMostStamp`
std::optional<Nanoseconds> parse_stamp(std::string_view text, TimeUnit unit);

/// The most plausible unit of a column of times without a unit: for times since 1970 by their size,
/// for others by their spacing, which is assumed to be at most 50 s.
/// @param first the first time, in units
/// @param spacing the usual difference of neighbours, in units; 0 if there is only one
TimeUnit usual_time_unit(double first, double spacing);

/// A column of times in nanoseconds.
struct StampColumn {
  std::vector<Nanoseconds> stamps;
  std::vector<double> since_first;  ///< Seconds, with all written digits.
  TimeUnit unit = TimeUnit::kSeconds;
};
/// Parses times; dates if the first word is a date.
/// @param unit if empty, `usual_time_unit`
/// @param place gives the place of word `i`, such as "poses.txt: line 3"
/// @throws DataError for a word that is no time
StampColumn parse_stamps(const std::vector<std::string_view>& words, std::optional<TimeUnit> unit,
                         const std::function<std::string(std::size_t)>& place);

/// The times of scans, from the names of their files.
struct NameStamps {
  std::vector<Nanoseconds> stamps;  ///< Of each name, all different.
  bool since_1970 = true;           ///< False for times with another zero, such as "5.90125".
  /// The chosen interpretation if there are several; else empty.
  std::string note;
};

/// The times in the names of scans, without extensions: seconds since 1970 with any decimals
/// ("1317384506.4", "cloud_1317384506_400000100"), also without leading zeros behind the mark; such
/// times as 13, 16 or 19 digits; decimal numbers with another zero ("0.1"); and dates
/// ("2014_11_10_11_32_17.25", "20141110T113217").
/// @param stems in any order
/// @param span first and last time of the poses; of several interpretations, the most even one
///   within `span` is chosen
/// @return empty unless all are such names and all times differ; "000123" and "frame1.10" are no
///   such names
std::optional<NameStamps> stamps_in_names(
    const std::vector<std::string>& stems,
    const std::optional<std::pair<Nanoseconds, Nanoseconds>>& span = std::nullopt);

/// Parses "2011-09-26 13:02:25.964389445", or with a T between date and time, perhaps with Z or
/// +01:00 behind it; without these it is UTC. @return empty for other texts
std::optional<Nanoseconds> parse_date(std::string_view text);

/// Reads a file with one time per line: seconds (also with an exponent), milliseconds, microseconds
/// or nanoseconds, see `usual_time_unit`, or dates as in KITTI's raw data
/// ("2011-09-26 13:02:25.964389445").
/// @throws DataError with file and line for a word that is no time
StampColumn read_stamp_file(const std::filesystem::path& path);

}  // namespace raymoval
