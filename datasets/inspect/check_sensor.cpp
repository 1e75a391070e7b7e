// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/error.h"
#include "core/text.h"
#include "core/voxel_key.h"
#include "datasets/inspect/checks.h"
#include "datasets/inspect/pose_fit.h"

namespace raymoval::inspection {
namespace {

using Eigen::Vector3d;

/// The plane that the sensor's vehicle stands on, n . p = offset with n up.
struct GroundPlane {
  Vector3d normal = Vector3d::UnitZ();
  double offset = -1.0;
  [[nodiscard]] double height(const Vector3d& point) const { return normal.dot(point) - offset; }
};

GroundPlane ground_of(const Samples& samples) {
  Vector3d normal = Vector3d::Zero();
  std::vector<Surfel> flat;
  for (const auto& [index, scan] : samples.scans()) {
    for (const Surfel& surfel : samples.surfels(index)) {
      if (surfel.group != Surfel::Group::kNormalZ || std::abs(surfel.axis.z()) < 0.85) continue;
      if (surfel.mean.norm() > 15.0 || surfel.mean.z() > -0.3) continue;
      normal += surfel.axis.z() > 0.0 ? surfel.axis : Vector3d(-surfel.axis);
      flat.push_back(surfel);
    }
  }
  GroundPlane plane;
  if (flat.empty()) return plane;
  plane.normal = normal.normalized();
  std::vector<double> offsets;
  for (const Surfel& surfel : flat) offsets.push_back(plane.normal.dot(surfel.mean));
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  plane.offset = *middle;
  return plane;
}

/// Scans between which the sensor went some way, a turn by 20 degrees counting as a metre.
std::vector<std::size_t> scans_apart(const Samples& samples) {
  constexpr double kApart = 1.0, kMetresPerRadian = 3.0;
  std::vector<std::size_t> chosen;
  for (const auto& [index, scan] : samples.scans()) {
    bool apart = true;
    for (const std::size_t other : chosen) {
      const Pose motion = samples.poses()[other].inverse() * samples.poses()[index];
      const double turn = Eigen::AngleAxisd(motion.linear()).angle();
      apart = apart && motion.translation().norm() + kMetresPerRadian * turn >= kApart;
    }
    if (apart) chosen.push_back(index);
  }
  return chosen;
}

/// Cells of the sensor frame above the ground that hold points in nearly every one of `scans`.
VoxelSet steady_cells(const Samples& samples, const std::vector<std::size_t>& scans,
                      const GroundPlane& ground, double edge, double reach) {
  constexpr double kAboveGround = 0.4, kNearlyAll = 0.85;
  VoxelMap<std::size_t> seen;
  for (const std::size_t scan : scans) {
    VoxelSet here;
    for (const Eigen::Vector3f& point : samples.scans().at(scan).points) {
      const Vector3d p = point.cast<double>();
      if (p.norm() > reach || ground.height(p) < kAboveGround) continue;
      here.insert(voxel_key(voxel_index(p, 1.0 / edge)));
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

/// What is known of the points that go along with the sensor.
struct EgoPoints {
  std::size_t points = 0, evaluated = 0, labelled = 0;
  double farthest = 0.0;
  std::map<std::uint16_t, std::size_t> ids;
};

EgoPoints look_at_points(const Samples& samples, const std::vector<std::size_t>& scans,
                         const VoxelSet& steady, double edge, double reach) {
  EgoPoints ego;
  const Sequence& sequence = samples.sequence();
  for (const std::size_t index : scans) {
    const Scan& scan = samples.scans().at(index);
    std::vector<std::uint32_t> words;
    try {
      if (sequence.labels) words = sequence.labels->labels(scan);
    } catch (const DataError&) {
      words.clear();  // Reported by the checks of labels.
    }
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Vector3d p = scan.points[i].cast<double>();
      if (p.norm() > reach || steady.count(voxel_key(voxel_index(p, 1.0 / edge))) == 0) continue;
      ++ego.points;
      if (!sequence.range_m.contains(p.norm())) continue;
      ++ego.evaluated;
      ego.farthest = std::max(ego.farthest, p.norm());
      if (words.empty()) continue;
      ++ego.ids[semantic_id(words[i])];
      if (sequence.label_rule.classify(words[i]) != LabelClass::kStatic) ++ego.labelled;
    }
  }
  return ego;
}

std::string ids_text(const EgoPoints& ego) {
  std::vector<std::string> ids;
  for (const auto& [id, count] : ego.ids) {
    if (10 * count >= ego.evaluated) ids.push_back(std::to_string(id));
  }
  return join(ids);
}

/// Of `steady`, the cells that hang together with one nearer than `start` to the sensor; empty if
/// they go on to `end`.
VoxelSet grown_from_sensor(const VoxelSet& steady, double edge, double start, double end) {
  const auto distance = [edge](VoxelKey key) {
    return ((voxel_index(key).cast<double>().array() + 0.5) * edge).matrix().norm();
  };
  VoxelSet own;
  std::vector<VoxelKey> open;
  for (const VoxelKey key : steady) {
    if (distance(key) <= start && own.insert(key).second) open.push_back(key);
  }
  while (!open.empty()) {
    const VoxelIndex at = voxel_index(open.back());
    if (distance(open.back()) > end) return {};
    open.pop_back();
    for (int k = 0; k < 27; ++k) {
      const VoxelKey next =
          voxel_key(VoxelIndex(at + VoxelIndex(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (steady.count(next) > 0 && own.insert(next).second) open.push_back(next);
    }
  }
  return own;
}

/// Points that keep their place in the sensor frame while the sensor moves. A wall or a guard rail
/// along the way does so too, but it begins farther from the sensor or goes on; a vehicle ends.
std::vector<Finding> look_for_ego(Samples& samples) {
  constexpr double kEdge = 0.25, kStart = 2.5, kEnd = 8.5, kReach = 9.0;
  constexpr std::size_t kFewestCells = 4, kFewestScans = 5;
  if (!pose_verdict(samples).check.empty()) return {};
  const std::vector<std::size_t> scans = scans_apart(samples);
  if (scans.size() < kFewestScans) return {};
  const VoxelSet steady = steady_cells(samples, scans, ground_of(samples), kEdge, kReach);
  const VoxelSet own = grown_from_sensor(steady, kEdge, kStart, kEnd);
  samples.measures.emplace_back("steady_cells", static_cast<double>(steady.size()));
  samples.measures.emplace_back("steady_cells_at_sensor", static_cast<double>(own.size()));
  if (own.size() < kFewestCells) return {};
  const EgoPoints ego = look_at_points(samples, scans, own, kEdge, kReach);
  if (ego.evaluated < 10 * scans.size()) return {};
  Finding finding;
  finding.where = "points of all scans read";
  finding.what = "about " + grouped_text(ego.evaluated / scans.size()) + " points a scan, up to " +
                 fixed_text(ego.farthest, 1) +
                 " m away, go along with the sensor: it sees the machine that carries it";
  if (10 * ego.labelled >= 8 * ego.evaluated) {
    finding.severity = Severity::kNote;
    finding.what += "; their labels say so (" + ids_text(ego) + ")";
    finding.remedy = "Nothing, if that machine is meant to be in the evaluation.";
  } else {
    finding.remedy = "Evaluate points from " + fixed_text(ego.farthest + 0.1, 1) +
                     " m on (--range or \"range_m\" in sequence.json), or label them with an id "
                     "that the rule ignores.";
  }
  return {finding};
}

}  // namespace

std::vector<Check> sensor_checks() {
  return {
      {"ego-vehicle", "the machine that carries the sensor is in view",
       "no point of it within the evaluated range", "Set range_m.min beyond it.", look_for_ego},
  };
}

}  // namespace raymoval::inspection
