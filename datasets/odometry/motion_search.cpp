// SPDX-License-Identifier: MIT
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "datasets/odometry/map_registration.h"
#include "datasets/odometry/steps.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::odometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTryStep = 0.75;                       // metres between the motions that are tried
constexpr double kTryReach = 0.5, kMostTryReach = 2.0;  // metres
constexpr double kFastest = 45.0;                       // metres a second
constexpr double kFarthestStep = 20.0;                  // metres from scan to scan
constexpr double kMostPeriods = 5.0;  // periods that a prediction extends over a gap in time
constexpr double kUsualPeriod = 0.1;  // seconds, where scans have no times
constexpr double kAlike = 0.3;        // metres
constexpr std::size_t kFewTried = 2000;
constexpr double kLeastOfMatched = 0.6;  // Of the matched share of the best.
/// Scans after which motions with less overlap than the best are dropped, and how much less.
constexpr std::pair<std::size_t, double> kRounds[] = {{3, 0.06}, {6, 0.04}, {kSearchedScans, 1.0}};

/// A scan that is thinned once, or, with times of points, for each motion.
class SearchedScans {
 public:
  SearchedScans(const MovingScans& input, std::size_t begin, std::size_t count)
      : scale_(input.scale) {
    for (std::size_t i = begin; i < begin + count; ++i) {
      throw_if_cancelled(input.cancel);
      Scan scan = input.scans.load(i);
      times_.push_back(scan.time_s);
      if (input.point_times) {
        point_times_.push_back(input.point_times(scan));
        scans_.push_back(std::move(scan));
      } else {
        thin_.push_back(thinned(scan, {}, scale_));
      }
    }
  }
  [[nodiscard]] std::size_t size() const { return times_.size(); }
  /// Seconds from scan `i` to the next.
  [[nodiscard]] double period(std::size_t i) const {
    const double seconds = times_[i + 1] - times_[i];
    return seconds > 0.0 ? seconds : kUsualPeriod;
  }
  /// @param motion T_before_after of the sensor from scan `i` to the next
  [[nodiscard]] ThinnedScan thin(std::size_t i, const Pose& motion) const {
    if (!thin_.empty()) return thin_[i];
    return thinned(scans_[i], {point_times_[i], motion, period(std::min(i, size() - 2))}, scale_);
  }

 private:
  ScanScale scale_;
  std::vector<Scan> scans_;
  std::vector<std::vector<double>> point_times_;
  std::vector<ThinnedScan> thin_;
  std::vector<double> times_;
};

/// Registers one scan after the other to the map of those before, with constant velocity.
class Track {
 public:
  Track(const SearchedScans& scans, double cell_m, const Pose& motion)
      : scans_(&scans), map_(cell_m), motion_(motion) {
    map_.add(scans.thin(0, motion).dense);
  }
  /// @param poses null, or predictions in place of constant velocity
  void follow(std::size_t end, const std::vector<Pose>* poses = nullptr) {
    for (end = std::min(end, scans_->size()); next_ < end; ++next_) {
      const double part = next_ == 1 ? 1.0 : scans_->period(next_ - 1) / scans_->period(next_ - 2);
      const Pose predicted = poses == nullptr ? part_of(motion_, std::min(part, kMostPeriods))
                                              : (*poses)[next_ - 1].inverse() * (*poses)[next_];
      const double reach =
          std::min(3.0 * usual_deviation(scans_->period(next_ - 1)), kMostTryReach);
      const ThinnedScan thin = scans_->thin(next_, predicted);
      const Registered found =
          register_to_map(map_, few_of(thin.sparse, kFewTried), pose_ * predicted,
                          poses == nullptr ? reach : kLeastReach);
      motion_ = pose_.inverse() * found.T_map_sensor;
      pose_ = found.T_map_sensor;
      if (next_ == 1) tried_.first = motion_;
      tried_.last = motion_;
      found_.push_back(found);
      map_.add(thin.dense, pose_);
    }
  }
  /// With the means of the later half of the scans.
  [[nodiscard]] TriedMotion tried() const {
    TriedMotion tried = tried_;
    const std::size_t half = found_.size() / 2;
    const auto count = static_cast<double>(found_.size() - half);
    for (std::size_t k = half; k < found_.size(); ++k) {
      tried.overlap += found_[k].overlap / count;
      tried.matched += found_[k].matched / count;
    }
    return tried;
  }

 private:
  const SearchedScans* scans_;
  PlaneMap map_;
  Pose pose_ = Pose::Identity(), motion_;
  TriedMotion tried_;
  std::vector<Registered> found_;
  std::size_t next_ = 1;
};

/// The direction along which the surfaces of two scans determine the motion least.
Vector3d weakest_direction(const SearchedScans& scans, double cell_m, const Pose& guess) {
  PlaneMap map(cell_m);
  map.add(scans.thin(0, guess).dense);
  Matrix3d normals = Matrix3d::Zero();
  for (const auto& match : map.match(scans.thin(1, guess).sparse, guess, kTryReach)) {
    normals += match.weight * match.normal * match.normal.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(normals).eigenvectors().col(0);
}

bool fits_better(const TriedMotion& a, const TriedMotion& b) {
  return a.overlap * a.matched > b.overlap * b.matched;
}

/// The result of a search. Of motions that are alike, the one that fits best counts: their overlap
/// depends on the first scan's error. Of others, the one with the largest overlap does.
MotionSearch result_of(std::vector<TriedMotion> tried, const TriedMotion& given) {
  MotionSearch result{given, given, {}};
  double matched = given.matched;
  for (const TriedMotion& one : tried) matched = std::max(matched, one.matched);
  std::stable_sort(tried.begin(), tried.end(), fits_better);
  std::vector<TriedMotion> distinct = {given};
  for (const TriedMotion& one : tried) {
    const bool is_known = std::any_of(distinct.begin(), distinct.end(),
                                      [&](const TriedMotion& kept) { return one.is_like(kept); });
    if (one.is_like(given) && fits_better(one, result.alike)) result.alike = one;
    if (is_known || one.matched < kLeastOfMatched * matched) continue;
    distinct.push_back(one);
    if (one.overlap > result.other.overlap) result.other = one;
  }
  return result;
}

void drop_bad(std::vector<Track>& tracks, double given, double margin) {
  double best = given;
  for (const Track& track : tracks) best = std::max(best, track.tried().overlap);
  std::erase_if(tracks, [&](const Track& t) { return t.tried().overlap < best - margin; });
}

}  // namespace

bool TriedMotion::is_like(const TriedMotion& other) const {
  return (last.translation() - other.last.translation()).norm() < kAlike;
}

MotionSearch search_motion(const MovingScans& input, std::size_t begin,
                           const std::vector<Pose>& poses) {
  const SearchedScans scans(input, begin, std::min(kSearchedScans, poses.size()));
  const double cell_m = input.scale.cell;
  const Pose motion = poses[0].inverse() * poses[1];
  const Vector3d along = weakest_direction(scans, cell_m, motion);
  const double most =
      std::min({kFastest * scans.period(0), kFarthestStep, 2.0 * input.scale.range});
  const int steps = static_cast<int>(std::ceil(most / kTryStep));
  Track given(scans, cell_m, motion);
  std::vector<Track> tracks;
  for (int k = -steps; k <= steps; ++k) {
    if (k != 0)
      tracks.emplace_back(scans, cell_m, Eigen::Translation3d(kTryStep * k * along) * motion);
  }
  for (const auto& [end, margin] : kRounds) {
    given.follow(end, &poses);
    parallel_for(input.threads, tracks.size(), 1, [&](std::size_t k) { tracks[k].follow(end); });
    drop_bad(tracks, given.tried().overlap, margin);
  }
  std::vector<TriedMotion> tried;
  for (const Track& track : tracks) tried.push_back(track.tried());
  return result_of(std::move(tried), given.tried());
}

}  // namespace raymoval::odometry
