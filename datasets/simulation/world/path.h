// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/files/fields.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {

/// A smooth path over the ground, parametrised by the distance along it (metres).
class Path {
 public:
  Path() = default;
  /// Corners of `points` are rounded (Chaikin's corner cutting), ends kept.
  /// @throws ConfigurationError for fewer than two points or two equal ones.
  Path(const std::vector<Eigen::Vector2d>& points, bool closed);

  [[nodiscard]] double length() const { return distance_.back(); }
  [[nodiscard]] bool closed() const { return closed_; }
  /// Position `s` metres along, `left` metres to the left. Beyond an open end it is straight.
  [[nodiscard]] Eigen::Vector2d at(double s, double left = 0.0) const;
  /// Unit direction of travel, smooth along the path.
  [[nodiscard]] Eigen::Vector2d direction(double s) const;
  /// Corners of the rounded line and their distances along it.
  [[nodiscard]] const std::vector<Eigen::Vector2d>& points() const { return points_; }
  [[nodiscard]] const std::vector<double>& distances() const { return distance_; }

 private:
  [[nodiscard]] Eigen::Vector2d on_line(double s) const;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> distance_;
  bool closed_ = false;
};

/// Speed over time, linear between the given (seconds, metres per second); constant outside. Also
/// height over distance.
class SpeedProfile {
 public:
  SpeedProfile() : SpeedProfile({{0.0, 0.0}}) {}
  explicit SpeedProfile(std::vector<std::pair<double, double>> knots);
  [[nodiscard]] double speed(double time) const;
  /// Metres travelled between time 0 and `time`; negative before 0.
  [[nodiscard]] double distance(double time) const;

 private:
  [[nodiscard]] double from_first_knot(double time) const;
  std::vector<std::pair<double, double>> knots_;
  std::vector<double> travelled_;  ///< Up to each knot.
};

/// Vehicles that arrive at a line, queue there, and leave one after another.
struct QueueSpec {
  std::string road;
  bool reverse = false;
  std::vector<double> lanes_m;   ///< One column per lane, left of the road's middle, seen along it.
  double line_m = 0.0;           ///< Distance along the route of the heads of the columns.
  int count = 10;                ///< In each column.
  NumberRange gap_m{1.0, 3.0};   ///< From bumper to bumper.
  NumberRange side_m{0.0, 0.0};  ///< Left of the middle of the column.
  std::vector<std::pair<std::string, double>> kinds;  ///< With weights.
  double arrived = 1.0;   ///< Share of each column that has arrived when the sequence begins.
  double start_s = 10.0;  ///< When the heads may go.
  NumberRange reaction_s{0.4, 1.2};  ///< Delay of a vehicle's start after the vehicle ahead.
  double speed_mps = 8.0;            ///< When arriving and leaving.
  double acceleration_mps2 = 2.0;
};

/// A vehicle of a column: its place, arrival and departure.
struct QueuePlace {
  double start_m = 0.0;  ///< Distance along the route at time 0.
  double left_m = 0.0;
  SpeedProfile speed;
};

/// Places of one column in their order, for bodies of `lengths_m` metres. Vehicles never collide:
/// all brake and accelerate alike, and later than the vehicles ahead.
std::vector<QueuePlace> queue_places(const QueueSpec& spec, const std::vector<double>& lengths_m,
                                     Random& random);

}  // namespace raymoval::simulated
