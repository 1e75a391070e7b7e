// SPDX-License-Identifier: MIT
#include "datasets/odometry/odometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kFirstReach = 2.0;    // Threshold before a motion is known, metres.
constexpr double kLeastMotion = 0.1;   // Smaller deviations do not count (KISS-ICP), metres.
constexpr double kRangeOfTurns = 3.0;  // Median ranges at which a turn is measured.
constexpr double kMostGap = 5.0;       // Motions that a prediction extends over a gap in time.
constexpr double kGap = 2.5;           // Periods that are a gap in time.
constexpr double kMapRadius = 100.0, kForgetEvery = 10.0;  // metres
constexpr double kUsualFit = 0.92;  // A smaller share of the usual fit is registered again.
constexpr double kUsualMemory = 0.9;
constexpr double kTurnStep = 1.5 * kDegree;
constexpr double kSecondReach = 1.0;  // metres
constexpr std::size_t kBestTurns = 6;
constexpr std::size_t kFewPoints = 500, kFewestRough = 50;
constexpr double kSearchStep = 0.25;  // metres
constexpr int kSearchSteps = 24;      // in each direction

}  // namespace

Odometry::Odometry(const ScanScale& scale, const std::optional<Pose>& first_motion)
    : scale_(scale), first_motion_(first_motion), map_(scale.cell) {}

Pose Odometry::predicted(double time_s) const {
  if (poses_.empty()) return Pose::Identity();
  if (poses_.size() < 2) return poses_[0] * first_motion_.value_or(Pose::Identity());
  const double before = times_[1] - times_[0], now = time_s - times_[1];
  const double part = before > 0.0 && now > 0.0 ? std::min(now / before, kMostGap) : 1.0;
  return poses_[1] * part_of(poses_[0].inverse() * poses_[1], part);
}

double Odometry::threshold() const {
  if (deviations_ == 0) return kFirstReach;
  return std::clamp(3.0 * std::sqrt(squares_ / deviations_), kLeastReach, kFirstReach);
}

/// The size of a deviation is the largest distance that it moves points (KISS-ICP, equation 6).
void Odometry::learn(const Pose& deviation) {
  const double angle = Eigen::AngleAxisd(deviation.linear()).angle();
  const double size =
      deviation.translation().norm() + 2.0 * kRangeOfTurns * scale_.range * std::sin(0.5 * angle);
  if (size < kLeastMotion) return;
  squares_ += size * size;
  ++deviations_;
}

Pose Odometry::searched(const std::vector<Vector3f>& points, const Pose& guess) const {
  PlaneMap own(map_.cell());
  own.add(points);
  // On planes and rings, motions look alike.
  const std::vector<Vector3f> rough = few_of(own.rough(points), kFewPoints);
  if (rough.size() < kFewestRough) return guess;
  const double reach = 0.5 * map_.cell();
  Pose best = guess;
  double most = map_.closeness(rough, guess, reach);
  for (int x = -kSearchSteps; x <= kSearchSteps; ++x) {
    for (int y = -kSearchSteps; y <= kSearchSteps; ++y) {
      const Pose start = guess * Eigen::Translation3d(kSearchStep * x, kSearchStep * y, 0.0);
      const double close = map_.closeness(rough, start, reach);
      if (close <= most) continue;
      most = close;
      best = start;
    }
  }
  return best;
}

Registered Odometry::again(const std::vector<Vector3f>& points, const Pose& guess,
                           const Registered& found, double reach) const {
  Registered best = found;
  const auto improve = [&](const Pose& start) {
    const Registered other = register_to_map(map_, points, start, kSecondReach);
    if (other.fit() > best.fit()) best = other;
    return best.fit() >= kUsualFit * usual_fit_;
  };
  // Near points may fit while far points lie beyond the least reach.
  if (improve(found.T_map_sensor)) return best;
  const std::vector<Vector3f> few = few_of(points, kFewPoints);
  std::vector<Registered> turned;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-3, -2, -1, 1, 2, 3}) {
      const Pose start = guess * Eigen::AngleAxisd(kTurnStep * step, Vector3d::Unit(axis));
      turned.push_back(register_to_map(map_, few, start, reach));
    }
  }
  std::stable_sort(turned.begin(), turned.end(),
                   [](const Registered& a, const Registered& b) { return a.fit() > b.fit(); });
  for (std::size_t k = 0; k < kBestTurns; ++k) {
    if (improve(turned[k].T_map_sensor)) break;
  }
  return best;
}

Registered Odometry::registered(const ThinnedScan& thin, const std::vector<Pose>& guesses) const {
  const double reach = threshold();
  Registered best = register_to_map(map_, thin.sparse, guesses[0], reach);
  for (std::size_t k = 1; k < guesses.size(); ++k) {
    const Registered other = register_to_map(map_, thin.sparse, guesses[k], reach);
    if (other.fit() > best.fit()) best = other;
  }
  return best.fit() < kUsualFit * usual_fit_ ? again(thin.sparse, guesses[0], best, reach) : best;
}

void Odometry::extend(const ThinnedScan& thin, const Pose& T_map_sensor, double time_s) {
  map_.add(thin.dense, T_map_sensor);
  if ((T_map_sensor.translation() - forgot_at_).norm() > kForgetEvery) {
    map_.forget_beyond(T_map_sensor.translation(), kMapRadius);
    forgot_at_ = T_map_sensor.translation();
  }
  if (poses_.size() == 2) {
    poses_.erase(poses_.begin());
    times_.erase(times_.begin());
  }
  poses_.push_back(T_map_sensor);
  times_.push_back(time_s);
}

Registered Odometry::add(const Scan& scan, std::vector<double> point_times,
                         const std::optional<Pose>& hint) {
  Pose guess = predicted(scan.time_s);
  ScanMotion motion{std::move(point_times)};
  if (!poses_.empty()) {
    motion.motion = poses_.back().inverse() * guess;
    motion.duration = scan.time_s - times_.back();
  }
  const ThinnedScan thin = thinned(scan, motion, scale_);
  Registered result{.overlap = 1.0, .matched = 1.0, .determined = true};
  if (!poses_.empty()) {
    if (poses_.size() == 1) {
      if (first_motion_) {
        squares_ = std::pow(usual_deviation(motion.duration), 2);
        deviations_ = 1;
      } else {
        guess = searched(thin.dense, hint ? poses_[0] * *hint : guess);
      }
    }
    std::vector<Pose> guesses = {guess};
    if (hint) guesses.push_back(poses_.back() * *hint);
    const bool is_gap = poses_.size() == 2 && motion.duration > kGap * (times_[1] - times_[0]) &&
                        times_[1] > times_[0];
    if (is_gap) {  // The sensor may have stopped, or moved on.
      guesses.push_back(poses_[1]);
      guesses.push_back(poses_[1] * poses_[0].inverse() * poses_[1]);
    }
    result = registered(thin, guesses);
    if (!is_gap) learn(guess.inverse() * result.T_map_sensor);
    usual_fit_ = usual_fit_ == 0.0
                     ? result.fit()
                     : kUsualMemory * usual_fit_ + (1.0 - kUsualMemory) * result.fit();
  }
  extend(thin, result.T_map_sensor, scan.time_s);
  return result;
}

}  // namespace raymoval::odometry
