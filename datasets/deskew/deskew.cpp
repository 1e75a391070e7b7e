// SPDX-License-Identifier: MIT
#include "datasets/deskew/deskew.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Duration of a scan, seconds. The longest is less than a thousand times the shortest, so that at
/// most one of s, ms, us and ns fits.
constexpr double kShortest = 0.002, kLongest = 1.9;

const PointField& time_field(const RecordLayout& layout, const std::string& place) {
  const PointField* field = layout.find(time_names());
  if (field != nullptr && field->count == 1) return *field;
  std::vector<std::string> there;
  for (const PointField& found : layout.fields) there.push_back(found.name);
  std::vector<std::string> wanted;
  for (const std::string_view name : time_names()) wanted.emplace_back(name);
  throw DataError(place + ": --deskew needs the time of each point, a field " + join(wanted, ", ") +
                  "; found " + (there.empty() ? "no field" : join(there)) +
                  ". Take scans that have it, or leave --deskew out.");
}

/// The least and the greatest time of the points of a scan, in units of the field.
struct Extent {
  double least = std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::lowest();
  [[nodiscard]] double span() const { return most - least; }
  [[nodiscard]] double middle() const { return least + 0.5 * span(); }
};

double time_of(const TimedScan& timed, const PointField& field, std::size_t point) {
  const double time = timed.records.value(timed.scan.stored_position(point), field);
  if (std::isfinite(time)) return time;
  throw DataError(timed.place + ": the time of point " +
                  grouped_text(timed.scan.stored_position(point)) +
                  " is not finite, although the point is a return.");
}

Extent extent_of(const TimedScan& timed, const PointField& field) {
  Extent extent;
  for (std::size_t i = 0; i < timed.scan.size(); ++i) {
    const double time = time_of(timed, field, i);
    extent.least = std::min(extent.least, time);
    extent.most = std::max(extent.most, time);
  }
  return extent;
}

/// The unit that gives the longest scan a plausible duration.
double usual_unit(double span, const PointClock& clock, const std::string& place) {
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (span * unit >= kShortest && span * unit <= kLongest) return unit;
  }
  throw DataError(place + ": the times of its points ('" + clock.field + "') span " +
                  number_text(span) +
                  ", which is not a time of a scan in s, ms, us or ns (2 ms to " +
                  "1.9 s). Give its unit: --point-time-unit SECONDS.");
}

/// Refuses a type with too few digits: a float32 that counts from 1970 has steps of minutes.
void check_digits(const PointField& field, const Extent& extent, double unit,
                  const std::string& place) {
  if (field.type != 'F' || field.size != 4) return;
  const auto largest = static_cast<float>(std::max(std::abs(extent.least), std::abs(extent.most)));
  const double step =
      static_cast<double>(std::nextafter(largest, std::numeric_limits<float>::max()) - largest);
  if (step * unit <= 1e-3) return;
  throw DataError(place + ": the times of its points are float32 in steps of " +
                  number_text(step * unit) + " s, which is too coarse for --deskew; write '" +
                  field.name + "' as float64, or as the time since the begin of the scan.");
}

/// Chooses the zero of the times: the zero with the smallest deviation of the middles of scans.
PointClock::Zero zero_of(const std::vector<TimedScan>& scans, const std::vector<Extent>& extents,
                         double unit) {
  double from_scan = 0.0, from_clock = 0.0;
  bool near_scan = true, near_clock = true;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double middle = extents[i].middle() * unit;
    const double apart = middle - to_seconds(scans[i].stamp);
    from_scan += std::abs(middle);
    from_clock += std::abs(apart);
    near_scan = near_scan && std::abs(middle) <= kLongest;
    near_clock = near_clock && std::abs(apart) <= kLongest;
  }
  if (near_scan && (!near_clock || from_scan <= from_clock)) return PointClock::Zero::kScanTime;
  return near_clock ? PointClock::Zero::kClock : PointClock::Zero::kFirstPoint;
}

std::string unit_text(double unit) {
  if (unit == 1.0) return "seconds";
  if (unit == 1e-3) return "milliseconds";
  if (unit == 1e-6) return "microseconds";
  if (unit == 1e-9) return "nanoseconds";
  return "steps of " + number_text(unit) + " s";
}

std::string zero_text(PointClock::Zero zero) {
  switch (zero) {
    case PointClock::Zero::kScanTime:
      return "from the time of the scan";
    case PointClock::Zero::kClock:
      return "on the clock of the scans";
    case PointClock::Zero::kFirstPoint:
      return "on another clock than the scans; the time of a scan is used as that of its earliest "
             "point";
  }
  return "";
}

}  // namespace

double seconds_of_unit(const std::string& text) {
  const std::pair<const char*, double> units[] = {
      {"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
  for (const auto& [name, seconds] : units) {
    if (text == name) return seconds;
  }
  const auto number = parse_number<double>(text);
  if (number && *number > 0.0 && *number <= 1.0) return *number;
  throw UsageError("--point-time-unit " + text +
                   ": expected s, ms, us, ns, or a number of seconds above 0 and up to 1.");
}

PointClock find_point_clock(const std::vector<TimedScan>& scans,
                            const std::optional<std::string>& unit) {
  PointClock clock;
  std::vector<Extent> extents;
  double span = 0.0;
  for (const TimedScan& timed : scans) {
    extents.push_back(extent_of(timed, time_field(timed.records.layout, timed.place)));
    span = std::max(span, extents.back().span());
  }
  const std::string& place = scans.front().place;
  const PointField& field = time_field(scans.front().records.layout, place);
  clock.field = field.name;
  if (!(span > 0.0)) {
    throw DataError(place + ": all points of a scan have the same time ('" + clock.field +
                    "'), so there is no motion to take out. Leave --deskew out.");
  }
  clock.unit_s = unit ? seconds_of_unit(*unit) : usual_unit(span, clock, place);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    check_digits(field, extents[i], clock.unit_s, scans[i].place);
  }
  clock.zero = zero_of(scans, extents, clock.unit_s);
  clock.longest_s = span * clock.unit_s;
  clock.text = clock.field + " in " + unit_text(clock.unit_s) + " " + zero_text(clock.zero);
  clock.notes.push_back("--deskew: the times of points ('" + clock.field + "') are read as " +
                        unit_text(clock.unit_s) + " " + zero_text(clock.zero) + ".");
  return clock;
}

std::vector<double> point_times(const TimedScan& timed, const PointClock& clock) {
  const PointField& field = time_field(timed.records.layout, timed.place);
  double zero = 0.0;
  if (clock.zero == PointClock::Zero::kClock) zero = to_seconds(timed.stamp) / clock.unit_s;
  if (clock.zero == PointClock::Zero::kFirstPoint) zero = extent_of(timed, field).least;
  std::vector<double> times;
  times.reserve(timed.scan.size());
  for (std::size_t i = 0; i < timed.scan.size(); ++i) {
    const double time = (time_of(timed, field, i) - zero) * clock.unit_s;
    if (std::abs(time) > 2.0 * kLongest) {
      throw DataError(timed.place + ": point " + grouped_text(timed.scan.stored_position(i)) +
                      " was taken " + number_text(time) +
                      " s from the time of its scan. Repair its time, or give the unit of '" +
                      clock.field + "': --point-time-unit.");
    }
    times.push_back(time);
  }
  return times;
}

namespace {

/// The poses of a sensor around the time of one scan.
class MotionAround {
 public:
  MotionAround(const SensorMotion& motion, Nanoseconds stamp, double longest_s, std::string place)
      : motion_(motion),
        stamp_(stamp),
        step_(std::max<Nanoseconds>(from_seconds(longest_s), 1)),
        place_(std::move(place)) {
    const auto pose = motion.at(stamp);
    if (!pose) throw InternalError(place_ + " has no pose");
    T_sensor_world_ = pose->inverse();
  }

  /// Transforms points measured `seconds` after the time of the scan to that time.
  [[nodiscard]] const Pose& since(double seconds) {
    if (known_ && seconds == last_) return moved_;
    last_ = seconds;
    known_ = true;
    moved_ = T_sensor_world_ * pose_at(stamp_ + from_seconds(seconds));
    return moved_;
  }

 private:
  [[nodiscard]] Pose pose_at(Nanoseconds time) const {
    if (const auto pose = motion_.at(time)) return *pose;
    const auto [first, last] = motion_.span();
    // Within a gap between poses, the last known time is the time of the scan.
    const Nanoseconds known = time < first ? first : time > last ? last : stamp_;
    const Nanoseconds beyond = time - known;
    if (std::abs(beyond) > step_ + step_ / 2) {
      throw DataError(place_ + ": has points " + stamp_text(beyond) +
                      " s from the nearest pose that is known, which is more than the time of a "
                      "scan. Take a trajectory that covers the scan, or leave it out (--frames).");
    }
    const Pose at_known = motion_.at(known).value();
    // The motion over the step before, or over the step after if there is none before.
    for (const Nanoseconds step : {beyond > 0 ? -step_ : step_, beyond > 0 ? step_ : -step_}) {
      const Nanoseconds other = std::clamp(known + step, first, last);
      const auto pose = motion_.at(other);
      if (!pose || other == known) continue;
      const double part = static_cast<double>(beyond) / static_cast<double>(other - known);
      return at_known * part_of(at_known.inverse() * *pose, part);
    }
    return at_known;  // A single pose: the sensor is stationary.
  }

  const SensorMotion& motion_;
  Nanoseconds stamp_;
  Nanoseconds step_;  ///< Duration of a scan.
  std::string place_;
  Pose T_sensor_world_ = Pose::Identity();
  bool known_ = false;
  double last_ = 0.0;
  Pose moved_ = Pose::Identity();
};

}  // namespace

PointClock find_point_clock(const ScanSource& scans, const DeskewInput& input,
                            const std::optional<std::string>& unit) {
  const std::size_t count = scans.size();
  std::vector<TimedScan> timed;
  for (std::size_t i : std::set<std::size_t>{0, count / 2, count - 1}) {
    Scan scan = scans.load(i);
    while (scan.points.empty() && i + 1 < count) scan = scans.load(++i);
    timed.push_back(
        {std::move(scan), input.records->records(i), input.stamps[i], input.records->place(i)});
  }
  PointClock clock = find_point_clock(timed, unit);
  const auto [first, last] = input.motion->span();
  bool beyond = false;
  for (const TimedScan& scan : timed) {
    for (const double time : point_times(scan, clock)) {
      const Nanoseconds stamp = scan.stamp + from_seconds(time);
      beyond = beyond || stamp < first || stamp > last;
    }
  }
  if (beyond && first < last) {
    clock.notes.push_back(
        "--deskew: points from before the first or after the last pose are corrected with the "
        "motion next to it.");
  }
  return clock;
}

DeskewedSource::DeskewedSource(std::shared_ptr<const ScanSource> whole, DeskewInput input,
                               PointClock clock)
    : DerivedSource(std::move(whole)), input_(std::move(input)), clock_(std::move(clock)) {
  if (input_.stamps.size() != whole_->size()) {
    throw InternalError("scans and their times differ in number");
  }
}

Scan DeskewedSource::load(std::size_t index) const {
  TimedScan timed{whole_->load(index), input_.records->records(index), input_.stamps.at(index),
                  input_.records->place(index)};
  const std::vector<double> times = point_times(timed, clock_);
  MotionAround motion(*input_.motion, timed.stamp, clock_.longest_s, timed.place);
  Pose T_moving_sensor = Pose::Identity();
  if (input_.several_sensors) {
    T_moving_sensor = input_.motion->at(timed.stamp)->inverse() * timed.scan.T_world_sensor;
  }
  const Pose T_sensor_moving = T_moving_sensor.inverse();
  for (std::size_t i = 0; i < times.size(); ++i) {
    Eigen::Vector3f& point = timed.scan.points[i];
    const Eigen::Vector3d in_moving = T_moving_sensor * point.cast<double>();
    point = (T_sensor_moving * (motion.since(times[i]) * in_moving)).cast<float>();
  }
  return std::move(timed.scan);
}

}  // namespace raymoval
