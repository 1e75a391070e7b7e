// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "datasets/odometry/map_registration.h"
#include "datasets/odometry/steps.h"
#include "datasets/registration/pose_fit.h"
#include "datasets/registration/station_grid.h"

namespace raymoval::odometry {
namespace {

using Eigen::Vector3d;

constexpr double kLoopStrideShare = 0.4, kLeastStride = 0.5,
                 kMostStride = 5.0;   // of the range; metres
constexpr double kPathStrides = 8.0;  // Shortest path between two passes, strides.
constexpr double kNear = 1.5;         // Distance of two passes, strides.
constexpr double kDrift = 0.01;       // Of the path between two passes.
constexpr double kMostDrift = 8.0;    // metres
constexpr double kStartStep = 1.0;    // Distance of the starts of registration, metres.
constexpr int kScansAround = 5;       // Scans of a place on either side.
constexpr std::size_t kFewLoopPoints = 400;
constexpr double kLeastLoopFit = 0.45;  // Of a match that is used.
constexpr double kSamePlace = 0.5;      // Matches within this distance are the same, metres.
constexpr double kDistinct = 0.85;      // Fit of another match, as a share of the best one's.
constexpr MotionSigma kLoopSigma{0.02, 0.0007};

struct Candidate {
  std::size_t from, to;
  double drift;  ///< Metres that the poses may be off.
};

/// For each station, the nearest earlier one to which the path returned.
std::vector<Candidate> candidates_of(const std::vector<Pose>& poses, double stride) {
  const std::vector<double> lengths = registration::path_lengths(poses);
  registration::StationGrid stations(poses, kNear * stride + kMostDrift);
  std::vector<Candidate> candidates;
  std::size_t last = poses.size();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (last < poses.size() && lengths[i] - lengths[last] < stride) continue;
    const Vector3d at = poses[i].translation();
    const auto drift_since = [&](std::size_t from) {
      return std::min(kDrift * (lengths[i] - lengths[from]), kMostDrift);
    };
    const std::size_t from = stations.nearest(at, i, [&](std::size_t station) {
      return lengths[i] - lengths[station] >= kPathStrides * stride &&
             (poses[station].translation() - at).norm() <= kNear * stride + drift_since(station);
    });
    if (from != i) candidates.push_back({from, i, drift_since(from)});
    stations.add(i);
    last = i;
  }
  return candidates;
}

/// Registers the scans of candidates.
class LoopSearch {
 public:
  LoopSearch(const MovingScans& input, const std::vector<Pose>& poses,
             const std::vector<double>& times, double stride)
      : input_(input), poses_(poses), times_(times), stride_(stride) {}

  [[nodiscard]] std::optional<GraphEdge> close(const Candidate& candidate) const {
    const PlaneMap map = map_around(candidate.from);
    const ThinnedScan scan = thin(candidate.to);
    const auto few = few_of(scan.sparse, kFewLoopPoints);
    const Pose guess = poses_[candidate.from].inverse() * poses_[candidate.to];
    const int steps = static_cast<int>(std::ceil(candidate.drift / kStartStep));
    std::vector<Registered> found;
    for (int x = -steps; x <= steps; ++x) {
      for (int y = -steps; y <= steps; ++y) {
        const Pose start = Eigen::Translation3d(kStartStep * x, kStartStep * y, 0.0) * guess;
        found.push_back(register_to_map(map, few, start, 1.5 * kStartStep));
      }
    }
    const Registered& best = *std::max_element(found.begin(), found.end(),
                                               [](auto& a, auto& b) { return a.fit() < b.fit(); });
    for (const Registered& other : found) {
      const double apart =
          (other.T_map_sensor.translation() - best.T_map_sensor.translation()).norm();
      if (apart > kSamePlace && other.fit() > kDistinct * best.fit()) return std::nullopt;
    }
    const Registered last = register_to_map(map, scan.sparse, best.T_map_sensor, kLeastReach);
    if (last.fit() < kLeastLoopFit || !last.determined) return std::nullopt;
    return GraphEdge{candidate.from, candidate.to, last.T_map_sensor, kLoopSigma, true};
  }

 private:
  [[nodiscard]] ThinnedScan thin(std::size_t i) const { return thinned(input_, poses_, times_, i); }
  /// A map of the scans within a stride of a scan, in its frame.
  [[nodiscard]] PlaneMap map_around(std::size_t centre) const {
    PlaneMap map(input_.scale.cell);
    std::vector<std::size_t> scans = {centre};
    for (const int direction : {-1, 1}) {
      Vector3d last = poses_[centre].translation();
      int count = 0;
      for (auto i = static_cast<std::ptrdiff_t>(centre) + direction;
           i >= 0 && i < static_cast<std::ptrdiff_t>(poses_.size()) && count < kScansAround;
           i += direction) {
        const Vector3d at = poses_[static_cast<std::size_t>(i)].translation();
        if ((at - last).norm() < stride_ / kScansAround) continue;
        last = at;
        ++count;
        scans.push_back(static_cast<std::size_t>(i));
      }
    }
    for (const std::size_t i : scans) {
      map.add(thin(i).dense, poses_[centre].inverse() * poses_[i]);
    }
    return map;
  }

  const MovingScans& input_;
  const std::vector<Pose>& poses_;
  const std::vector<double>& times_;
  double stride_;
};

}  // namespace

std::vector<GraphEdge> find_loops(const MovingScans& input, const std::vector<Pose>& poses,
                                  const std::vector<double>& times) {
  const double stride = std::clamp(kLoopStrideShare * input.scale.range, kLeastStride, kMostStride);
  const std::vector<Candidate> candidates = candidates_of(poses, stride);
  const LoopSearch search(input, poses, times, stride);
  std::vector<std::optional<GraphEdge>> found(candidates.size());
  if (input.progress != nullptr) input.progress->begin("closing loops", candidates.size());
  parallel_for(input.threads, candidates.size(), 1, [&](std::size_t i) {
    found[i] = search.close(candidates[i]);
    if (input.progress != nullptr) input.progress->advance();
  });
  if (input.progress != nullptr) input.progress->end();
  std::vector<GraphEdge> edges;
  for (const auto& edge : found) {
    if (edge) edges.push_back(*edge);
  }
  return edges;
}

}  // namespace raymoval::odometry
