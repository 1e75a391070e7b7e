// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace raymoval::simulated {

/// A smooth way over the ground, measured by the distance along it (metres).
class Path {
 public:
  Path() = default;
  /// Corners of `points` are rounded (Chaikin's corner cutting), ends kept.
  /// @throws ConfigurationError for fewer than two points or two equal ones.
  Path(const std::vector<Eigen::Vector2d>& points, bool closed);

  [[nodiscard]] double length() const { return distance_.back(); }
  [[nodiscard]] bool closed() const { return closed_; }
  /// Position `s` metres along, `left` metres to the left. Beyond an open end it runs straight on.
  [[nodiscard]] Eigen::Vector2d at(double s, double left = 0.0) const;
  /// Unit direction of travel, smooth along the way.
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

/// Speed over time, linear between the given (seconds, metres per second); constant outside.
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

}  // namespace raymoval::simulated
