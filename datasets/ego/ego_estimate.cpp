// SPDX-License-Identifier: MIT
#include "datasets/ego/ego_estimate.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/sampling.h"

namespace raymoval {
namespace {

using Eigen::Vector3d;

/// The machine begins nearer to the sensor than `kStart`, and ends nearer than `kEnd`, metres.
constexpr double kStart = 2.5, kEnd = 8.5, kReach = 9.0;

/// The plane below the ego vehicle, n . p = offset with n up.
struct GroundPlane {
  Vector3d normal = Vector3d::UnitZ();
  double offset = -1.0;
  double ceiling = std::numeric_limits<double>::infinity();  ///< Height, metres.
  [[nodiscard]] double height(const Vector3d& point) const { return normal.dot(point) - offset; }
};

using SurfelsOf = std::function<const std::vector<Surfel>&(std::size_t)>;

constexpr double kTilted = 0.5;   // Cosine of the largest tilt of a hand-held sensor.
constexpr double kUpright = 0.9;  // Cosine of the largest tilt of a sensor that counts as upright.

/// Candidates for the ground among the surfels of all scans, with axes up: not above the sensor (an
/// origin of the points may lie on the ground), and tilted by less than 60 degrees.
/// @param up in the frame of each scan
std::vector<Surfel> ground_candidates(const std::vector<Vector3d>& up, const SurfelsOf& surfels) {
  constexpr double kFarthest = 15.0, kHighest = 0.3;
  std::vector<Surfel> candidates;
  for (std::size_t k = 0; k < up.size(); ++k) {
    for (Surfel surfel : surfels(k)) {
      const double rise = surfel.axis.dot(up[k]);
      if (surfel.is_line() || std::abs(rise) < kTilted) continue;
      if (rise < 0.0) surfel.axis = -surfel.axis;
      if (surfel.mean.norm() > kFarthest || surfel.axis.dot(surfel.mean) > kHighest) continue;
      candidates.push_back(surfel);
    }
  }
  return candidates;
}

/// Height of the ceiling above `ground`, which is fixed in the sensor frame as well; infinite if
/// there is none.
double ceiling_above(const GroundPlane& ground, std::size_t least, std::size_t scans,
                     const SurfelsOf& surfels) {
  constexpr double kLevel = 0.98, kAboveSensor = 0.3;  // cosine of 11 degrees; metres
  std::vector<double> heights;
  for (std::size_t k = 0; k < scans; ++k) {
    for (const Surfel& surfel : surfels(k)) {
      if (surfel.is_line() || std::abs(surfel.axis.dot(ground.normal)) < kLevel) continue;
      if (ground.normal.dot(surfel.mean) > kAboveSensor) {
        heights.push_back(ground.height(surfel.mean));
      }
    }
  }
  if (heights.size() < least) return std::numeric_limits<double>::infinity();
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), low, heights.end());
  return *low;
}

/// The most candidates that lie on one plane. A wall ahead of a tilted sensor may have as many in
/// one scan, but its distance changes.
std::vector<Surfel> largest_plane(const std::vector<Surfel>& candidates) {
  constexpr std::size_t kTrials = 100;
  constexpr double kSameTurn = 0.98, kSameHeight = 0.3;  // cosine of 11 degrees; metres
  std::vector<Surfel> best;
  for (const std::size_t trial : evenly_spread(candidates.size(), kTrials)) {
    const Surfel& one = candidates[trial];
    std::vector<Surfel> alike;
    for (const Surfel& other : candidates) {
      if (other.axis.dot(one.axis) < kSameTurn) continue;
      if (std::abs(one.axis.dot(other.mean - one.mean)) > kSameHeight) continue;
      alike.push_back(other);
    }
    if (alike.size() > best.size()) best = std::move(alike);
  }
  return best;
}

/// The plane of most surfels of all scans, below the sensor along its z axis; or along `world_up`
/// for a sensor that is tilted far, such as on its side: there a wall beside the path may have more
/// surfels.
GroundPlane ground_of(const std::vector<const Scan*>& scans, const SurfelsOf& surfels,
                      const Vector3d& world_up) {
  std::vector<Vector3d> up;  // In the frame of each scan.
  Vector3d mean = Vector3d::Zero();
  for (const Scan* scan : scans) {
    up.emplace_back(scan->T_world_sensor.linear().transpose() * world_up);
    mean += up.back() / static_cast<double>(scans.size());
  }
  std::vector<Surfel> best = largest_plane(
      ground_candidates(std::vector<Vector3d>(scans.size(), Vector3d::UnitZ()), surfels));
  if (mean.z() < kUpright) {
    std::vector<Surfel> other = largest_plane(ground_candidates(up, surfels));
    if (!other.empty()) best = std::move(other);
  }
  GroundPlane plane;
  if (best.empty()) return plane;
  Vector3d normal = Vector3d::Zero();
  for (const Surfel& surfel : best) normal += surfel.axis;
  plane.normal = normal.normalized();
  std::vector<double> offsets;
  for (const Surfel& surfel : best) offsets.push_back(plane.normal.dot(surfel.mean));
  plane.offset = median(std::move(offsets));
  plane.ceiling = ceiling_above(plane, best.size() / 10 + 1, scans.size(), surfels);
  return plane;
}

/// Cells of the sensor frame between ground and ceiling with points in nearly all of `scans`.
VoxelSet steady_cells(const std::vector<const Scan*>& scans, const GroundPlane& ground) {
  constexpr double kOffLevels = 0.4, kNearlyAll = 0.85;
  VoxelMap<std::size_t> seen;
  for (const Scan* scan : scans) {
    VoxelSet here;
    for (const Eigen::Vector3f& point : scan->points) {
      const Vector3d p = point.cast<double>();
      const double height = ground.height(p);
      if (!(p.norm() <= kReach) || height < kOffLevels || height > ground.ceiling - kOffLevels) {
        continue;
      }
      here.insert(voxel_key(voxel_index(p, 1.0 / kEgoCell)));
    }
    for (const VoxelKey key : here) ++seen[key];
  }
  VoxelSet steady;
  for (const auto& [key, count] : seen) {
    if (static_cast<double>(count) >= kNearlyAll * static_cast<double>(scans.size())) {
      steady.insert(key);
    }
  }
  return steady;
}

/// Removes cells that rain fills. Drops fill a cell evenly; points of a machine lie on surfaces.
void erase_filled(const std::vector<const Scan*>& scans, VoxelSet& steady) {
  constexpr double kThick = 0.035;  // metres, standard deviation; 0.07 if a cell is filled evenly
  struct Moments {
    double count = 0.0;
    Vector3d sum = Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  };
  VoxelMap<Moments> cells;
  for (const Scan* scan : scans) {
    for (const Eigen::Vector3f& point : scan->points) {
      const Vector3d p = point.cast<double>();
      if (!(p.norm() <= kReach)) continue;
      const VoxelKey key = voxel_key(voxel_index(p, 1.0 / kEgoCell));
      if (steady.count(key) == 0) continue;
      Moments& cell = cells[key];
      cell.count += 1.0;
      cell.sum += p;
      cell.squares += p * p.transpose();
    }
  }
  for (const auto& [key, cell] : cells) {
    const Vector3d mean = cell.sum / cell.count;
    const Eigen::Matrix3d spread = cell.squares / cell.count - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread, Eigen::EigenvaluesOnly);
    if (solver.eigenvalues()[0] > kThick * kThick) steady.erase(key);
  }
}

/// The cells of `steady` that are connected to a cell near the sensor; empty if they extend beyond
/// the machine.
VoxelSet grown_from_sensor(const VoxelSet& steady) {
  const auto distance = [](VoxelKey key) {
    return ((voxel_index(key).cast<double>().array() + 0.5) * kEgoCell).matrix().norm();
  };
  VoxelSet own;
  std::vector<VoxelKey> open;
  for (const VoxelKey key : steady) {
    if (distance(key) <= kStart && own.insert(key).second) open.push_back(key);
  }
  while (!open.empty()) {
    const VoxelIndex at = voxel_index(open.back());
    if (distance(open.back()) > kEnd) return {};
    open.pop_back();
    for (int k = 0; k < 27; ++k) {
      const VoxelKey next =
          voxel_key(VoxelIndex(at + VoxelIndex(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (steady.count(next) > 0 && own.insert(next).second) open.push_back(next);
    }
  }
  return own;
}

}  // namespace

bool EgoEstimate::contains(const Vector3d& point) const {
  return point.norm() <= kReach && own.count(voxel_key(voxel_index(point, 1.0 / kEgoCell))) > 0;
}

EgoRegion EgoEstimate::region() const {
  // Bridges cells that noise or a turn of the sensor leaves empty at times.
  constexpr double kRoom = 0.15;
  const auto rounded = [](double metres) { return std::round(metres * 100.0) / 100.0; };
  EgoRegion region;
  if (!found()) return region;
  region.kind = EgoRegion::Kind::kBox;
  for (const VoxelKey key : own) {
    const Vector3d low = voxel_index(key).cast<double>() * kEgoCell;
    region.box.extend((low.array() - kRoom).unaryExpr(rounded).matrix());
    region.box.extend((low.array() + kEgoCell + kRoom).unaryExpr(rounded).matrix());
  }
  return region;
}

std::vector<std::size_t> poses_apart(const std::vector<Pose>& poses,
                                     const std::vector<std::size_t>& candidates, std::size_t most) {
  constexpr double kApart = 1.0, kMetresPerRadian = 3.0;
  // The last chosen pose is compared first, because it nearly always decides.
  std::vector<std::size_t> apart;
  for (const std::size_t index : candidates) {
    const bool far = std::all_of(apart.rbegin(), apart.rend(), [&](std::size_t other) {
      const Pose motion = poses[other].inverse() * poses[index];
      const double turn = Eigen::AngleAxisd(motion.linear()).angle();
      return motion.translation().norm() + kMetresPerRadian * turn >= kApart;
    });
    if (far) apart.push_back(index);
  }
  if (apart.size() <= most) return apart;
  std::vector<std::size_t> chosen;
  for (const std::size_t k : evenly_spread(apart.size(), most)) chosen.push_back(apart[k]);
  return chosen;
}

EgoEstimate estimate_ego(const std::vector<const Scan*>& scans, const SurfelsOf& surfels,
                         const Vector3d& world_up) {
  EgoEstimate estimate;
  estimate.scans = scans.size();
  if (!estimate.has_enough_motion()) return estimate;
  VoxelSet steady = steady_cells(scans, ground_of(scans, surfels, world_up));
  erase_filled(scans, steady);
  estimate.steady = steady.size();
  estimate.own = grown_from_sensor(steady);
  return estimate;
}

}  // namespace raymoval
