// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/path.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector2d;

constexpr int kRoundings = 4;

std::vector<Vector2d> cut_corners(const std::vector<Vector2d>& points, bool closed) {
  std::vector<Vector2d> cut;
  const std::size_t count = points.size();
  const std::size_t edges = closed ? count : count - 1;
  if (!closed) cut.push_back(points.front());
  for (std::size_t i = 0; i < edges; ++i) {
    const Vector2d& a = points[i];
    const Vector2d& b = points[(i + 1) % count];
    if (closed || i > 0) cut.push_back(0.75 * a + 0.25 * b);
    if (closed || i + 1 < edges) cut.push_back(0.25 * a + 0.75 * b);
  }
  if (!closed) cut.push_back(points.back());
  return cut;
}

}  // namespace

Path::Path(const std::vector<Vector2d>& points, bool closed) : points_(points), closed_(closed) {
  if (points_.size() < (closed ? 3U : 2U)) {
    throw ConfigurationError("a path needs at least two points, a closed one three.");
  }
  if (points_.size() > 2) {
    for (int i = 0; i < kRoundings; ++i) points_ = cut_corners(points_, closed_);
  }
  if (closed_) points_.push_back(points_.front());
  distance_.push_back(0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const double step = (points_[i] - points_[i - 1]).norm();
    if (!(step > 1e-6)) throw ConfigurationError("a path has two equal points in a row.");
    distance_.push_back(distance_.back() + step);
  }
}

Vector2d Path::on_line(double s) const {
  if (closed_) s -= std::floor(s / length()) * length();
  const auto next = std::upper_bound(distance_.begin() + 1, distance_.end() - 1, s);
  const auto i = static_cast<std::size_t>(next - distance_.begin());
  const double share = (s - distance_[i - 1]) / (distance_[i] - distance_[i - 1]);
  return points_[i - 1] + share * (points_[i] - points_[i - 1]);
}

Vector2d Path::direction(double s) const {
  constexpr double kHalf = 0.75;
  return (on_line(s + kHalf) - on_line(s - kHalf)).normalized();
}

Vector2d Path::at(double s, double left) const {
  const Vector2d along = direction(s);
  return on_line(s) + left * Vector2d(-along.y(), along.x());
}

SpeedProfile::SpeedProfile(std::vector<std::pair<double, double>> knots)
    : knots_(std::move(knots)), travelled_{0.0} {
  if (knots_.empty()) throw ConfigurationError("a speed profile needs at least one entry.");
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double seconds = knots_[i].first - knots_[i - 1].first;
    if (!(seconds > 0.0)) {
      throw ConfigurationError("the times of a speed profile must grow from entry to entry.");
    }
    travelled_.push_back(travelled_.back() +
                         0.5 * (knots_[i].second + knots_[i - 1].second) * seconds);
  }
}

double SpeedProfile::speed(double time) const {
  if (time <= knots_.front().first) return knots_.front().second;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const auto& [t0, v0] = knots_[i - 1];
    const auto& [t1, v1] = knots_[i];
    if (time <= t1) return v0 + (v1 - v0) * (time - t0) / (t1 - t0);
  }
  return knots_.back().second;
}

double SpeedProfile::from_first_knot(double time) const {
  const double since = time - knots_.front().first;
  if (since <= 0.0) return knots_.front().second * since;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    if (time <= knots_[i].first) {
      const double seconds = time - knots_[i - 1].first;
      return travelled_[i - 1] + 0.5 * (knots_[i - 1].second + speed(time)) * seconds;
    }
  }
  return travelled_.back() + knots_.back().second * (time - knots_.back().first);
}

double SpeedProfile::distance(double time) const {
  return from_first_knot(time) - from_first_knot(0.0);
}

namespace {

/// Stationary from `arrival` to `start` (seconds), with the queue's speed before and after.
SpeedProfile stop_and_go(const QueueSpec& spec, double arrival, double start) {
  const double ramp = spec.speed_mps / spec.acceleration_mps2;
  return SpeedProfile({{arrival - ramp, spec.speed_mps},
                       {arrival, 0.0},
                       {start, 0.0},
                       {start + ramp, spec.speed_mps}});
}

SpeedProfile go(const QueueSpec& spec, double start) {
  return SpeedProfile(
      {{start, 0.0}, {start + spec.speed_mps / spec.acceleration_mps2, spec.speed_mps}});
}

}  // namespace

std::vector<QueuePlace> queue_places(const QueueSpec& spec, const std::vector<double>& lengths_m,
                                     Random& random) {
  std::vector<QueuePlace> places;
  const std::size_t count = lengths_m.size();
  const auto standing =
      static_cast<std::size_t>(std::lround(spec.arrived * static_cast<double>(count)));
  double start = spec.start_s;
  double at = spec.line_m;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) {
      start += random.between(spec.reaction_s.low, spec.reaction_s.high);
      at -= 0.5 * lengths_m[i - 1] + random.between(spec.gap_m.low, spec.gap_m.high);
    }
    at -= 0.5 * lengths_m[i];
    QueuePlace place;
    place.left_m = random.between(spec.side_m.low, spec.side_m.high);
    if (i < standing) {
      place.speed = go(spec, start);
    } else {
      // Arrivals are spread evenly over nine tenths of the time that the heads wait.
      const double share =
          static_cast<double>(i - standing + 1) / static_cast<double>(count - standing);
      place.speed = stop_and_go(spec, 0.9 * share * spec.start_s, start);
    }
    place.start_m = at - place.speed.distance(std::max(0.0, start));
    places.push_back(std::move(place));
  }
  return places;
}

}  // namespace raymoval::simulated
