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

/// What one of a column of times stands for. The number is that of the digits behind the point of a
/// second.
enum class TimeUnit { kSeconds = 0, kMilliseconds = 3, kMicroseconds = 6, kNanoseconds = 9 };

/// "seconds", "milliseconds" and so on.
const char* time_unit_name(TimeUnit unit);
/// The unit of "s", "sec", "ms", "us" or "ns"; nothing for other texts.
std::optional<TimeUnit> parse_time_unit(std::string_view text);

/// "1317384506400000100" (with `unit` nanoseconds) or "1.3173845064e+09" as nanoseconds, exactly:
/// no digit goes through a double. Digits behind the last nanosecond are rounded.
/// @return nothing if it is no number, or beyond `kMostStamp`
std::optional<Nanoseconds> parse_stamp(std::string_view text, TimeUnit unit);

/// The unit of a column of times that nobody named: times since 1970 tell it by their size, others
/// by the time from one to the next, which is taken to be 50 s at most.
/// @param first the first time, in units
/// @param spacing the usual difference of neighbours, in units; 0 if there is only one
TimeUnit usual_time_unit(double first, double spacing);

/// A column of times: `words` as nanoseconds, with the unit given or the usual one for them; or
/// dates, if the first one is a date.
struct StampColumn {
  std::vector<Nanoseconds> stamps;
  std::vector<double> since_first;  ///< Seconds, with the digits that seconds were written with.
  TimeUnit unit = TimeUnit::kSeconds;
};
/// @param unit nothing if nobody named one
/// @param place says where word `i` stands, such as "poses.txt: line 3"
/// @throws DataError for what is no time
StampColumn parse_stamps(const std::vector<std::string_view>& words, std::optional<TimeUnit> unit,
                         const std::function<std::string(std::size_t)>& place);

/// When scans were taken, by the names of their files.
struct NameStamps {
  std::vector<Nanoseconds> stamps;  ///< Of each name; no two are equal.
  bool since_1970 = true;           ///< False for times since anything else, such as "5.90125".
  /// How the names were read, if they can be read in several ways; else empty.
  std::string note;
};

/// The times in the names of scans, without extensions: seconds since 1970 with any decimals
/// ("1317384506.4", "cloud_1317384506_400000100"), also without leading zeros behind the mark; such
/// times as 13, 16 or 19 digits; and decimal numbers since anything else ("0.1").
/// @param stems in any order
/// @param span first and last time of the poses; of several readings the one is taken whose times
///   lie in it and follow each other most evenly
/// @return nothing unless all are such names and no two times are equal; "000123" and "frame1.10"
///   are none
std::optional<NameStamps> stamps_in_names(
    const std::vector<std::string>& stems,
    const std::optional<std::pair<Nanoseconds, Nanoseconds>>& span = std::nullopt);

/// "2011-09-26 13:02:25.964389445", or with a T between date and time, perhaps with Z or +01:00
/// behind it; without these it is UTC. @return nothing for other texts
std::optional<Nanoseconds> parse_date(std::string_view text);

/// A file with a time a line: seconds (also with an exponent), milliseconds, microseconds or
/// nanoseconds, told by `usual_time_unit`, or dates as KITTI's raw data have them
/// ("2011-09-26 13:02:25.964389445").
/// @throws DataError with file and line for what is no time
StampColumn read_stamp_file(const std::filesystem::path& path);

}  // namespace raymoval
