// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects.h"

#include <algorithm>

#include "methods/common/range_adaptive_clusters.h"

namespace raymoval {
namespace {

/// Clusters of some of a scan's points.
std::vector<int> clusters_of(const Scan& scan, const std::vector<std::size_t>& chosen,
                             const RaymovalPlusParameters& parameters) {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> ranges;
  for (const std::size_t k : chosen) {
    points.push_back(scan.points[k]);
    ranges.push_back(scan.points[k].norm());
  }
  return range_adaptive_clusters(points, ranges, static_cast<float>(parameters.cluster_gap),
                                 static_cast<float>(parameters.cluster_growth));
}

/// Scans that agree with a voxel; none with ground.
int agreeing(const EvidenceMap& map, std::uint32_t voxel) {
  return voxel == EvidenceMap::kNone ? 0 : map.evidence(voxel).agree_scans;
}

bool is_settled(const EvidenceMap& map, std::uint32_t voxel,
                const RaymovalPlusParameters& parameters) {
  return agreeing(map, voxel) >= parameters.settled_scans;
}

bool is_high(float height, const RaymovalPlusParameters& parameters) {
  return !parameters.terrain || height >= static_cast<float>(parameters.object_height);
}

/// Dynamic points of hardly dynamic clusters that hang together with enough others: 1 for each
/// of `objects.points`.
std::vector<std::uint8_t> spared_groups(const ScanObjects& objects, const WorldScan& world,
                                        const RaymovalPlusParameters& parameters) {
  std::vector<std::size_t> place, chosen;
  for (std::size_t i = 0; i < objects.points.size(); ++i) {
    const std::size_t k = objects.points[i];
    if (world.verdict[k] != Evidence::kDynamic) continue;
    if (objects.is_hardly_dynamic[static_cast<std::size_t>(objects.number[i])] == 0) continue;
    place.push_back(i);
    chosen.push_back(k);
  }
  const std::vector<int> group = clusters_of(world.scan, chosen, parameters);
  std::vector<int> size(chosen.size(), 0);
  for (const int g : group) ++size[static_cast<std::size_t>(g)];
  std::vector<std::uint8_t> spared(objects.points.size(), 0);
  for (std::size_t i = 0; i < place.size(); ++i) {
    spared[place[i]] = size[static_cast<std::size_t>(group[i])] >= parameters.group_points ? 1 : 0;
  }
  return spared;
}

/// Counts points and dynamic points of each cluster.
void count_points(const WorldScan& world, ScanObjects& objects) {
  objects.size.clear();
  objects.dynamic.clear();
  for (std::size_t i = 0; i < objects.points.size(); ++i) {
    const auto cluster = static_cast<std::size_t>(objects.number[i]);
    if (cluster >= objects.size.size()) {
      objects.size.resize(cluster + 1, 0);
      objects.dynamic.resize(cluster + 1, 0);
    }
    ++objects.size[cluster];
    if (world.verdict[objects.points[i]] == Evidence::kDynamic) ++objects.dynamic[cluster];
  }
}

/// Divides clusters that are neither mostly dynamic nor free of dynamic points.
void divide(const WorldScan& world, const EvidenceMap& map,
            const RaymovalPlusParameters& parameters, ScanObjects& objects) {
  std::vector<std::size_t> place, chosen;
  for (std::size_t i = 0; i < objects.points.size(); ++i) {
    const auto cluster = static_cast<std::size_t>(objects.number[i]);
    const int dynamic = objects.dynamic[cluster];
    if (dynamic < parameters.group_points ||
        dynamic >= parameters.object_dynamic_share * objects.size[cluster]) {
      continue;
    }
    const std::size_t k = objects.points[i];
    const std::uint32_t voxel = world.voxel[k];
    if (world.verdict[k] != Evidence::kDynamic && is_settled(map, voxel, parameters)) {
      continue;
    }
    place.push_back(i);
    chosen.push_back(k);
  }
  const std::vector<int> part = clusters_of(world.scan, chosen, parameters);
  const auto clusters = static_cast<int>(objects.size.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const auto cluster = static_cast<std::size_t>(objects.number[place[i]]);
    const auto number = static_cast<std::size_t>(clusters + part[i]);
    if (number >= objects.is_part.size()) {
      objects.is_part.resize(number + 1, 0);
      objects.is_hardly_dynamic.resize(number + 1, 0);
    }
    objects.is_part[number] = 1;
    objects.is_hardly_dynamic[number] = objects.is_hardly_dynamic[cluster];
    objects.number[place[i]] = static_cast<int>(number);
  }
  count_points(world, objects);
  objects.size.resize(objects.is_part.size(), 0);
  objects.dynamic.resize(objects.is_part.size(), 0);
}

}  // namespace

ScanObjects find_objects(const WorldScan& world, const EvidenceMap& map,
                         const RaymovalPlusParameters& parameters) {
  ScanObjects objects;
  const auto farthest = static_cast<float>(parameters.evidence_range_max);
  for (std::size_t k = 0; k < world.points.size(); ++k) {
    if (!is_high(world.height[k], parameters)) continue;
    if (world.scan.points[k].squaredNorm() > farthest * farthest) continue;
    objects.points.push_back(k);
  }
  objects.number = clusters_of(world.scan, objects.points, parameters);
  count_points(world, objects);
  objects.is_part.assign(objects.size.size(), 0);
  objects.is_hardly_dynamic.resize(objects.size.size());
  for (std::size_t c = 0; c < objects.size.size(); ++c) {
    objects.is_hardly_dynamic[c] =
        objects.dynamic[c] <= parameters.object_static_share * objects.size[c] ? 1 : 0;
  }
  if (parameters.settled_scans > 0) divide(world, map, parameters, objects);
  return objects;
}

std::vector<ObjectSummary> summaries(const ScanObjects& objects, const WorldScan& world,
                                     const EvidenceMap& map,
                                     const RaymovalPlusParameters& parameters) {
  std::vector<ObjectSummary> all(objects.size.size());
  for (ObjectSummary& object : all) {
    object.low.setConstant(1e30);
    object.high.setConstant(-1e30);
    object.center.setZero();
  }
  const Eigen::Vector3d sensor = world.scan.T_world_sensor.translation();
  for (std::size_t i = 0; i < objects.points.size(); ++i) {
    const std::size_t k = objects.points[i];
    ObjectSummary& object = all[static_cast<std::size_t>(objects.number[i])];
    object.low = object.low.cwiseMin(world.points[k]);
    object.high = object.high.cwiseMax(world.points[k]);
    object.center += world.points[k];
    ++object.points;
    if (world.verdict[k] == Evidence::kDynamic) {
      ++object.dynamic;
    } else {
      object.agree_scans += static_cast<float>(agreeing(map, world.voxel[k]));
    }
  }
  std::vector<ObjectSummary> followed;
  for (std::size_t c = 0; c < all.size(); ++c) {
    ObjectSummary& object = all[c];
    if (object.points < parameters.track_points || object.width() > parameters.track_width) {
      continue;
    }
    object.center /= object.points;
    object.range = static_cast<float>((object.center - sensor).norm());
    object.agree_scans /= static_cast<float>(std::max(object.points - object.dynamic, 1));
    object.cluster = static_cast<int>(c);
    followed.push_back(object);
  }
  return followed;
}

void judge_objects(const ScanObjects& objects, const std::vector<int>& marked,
                   const RaymovalPlusParameters& parameters, WorldScan& world) {
  std::vector<std::uint8_t> marks(objects.size.size(), 0);
  for (const int cluster : marked) marks[static_cast<std::size_t>(cluster)] = 1;
  const std::vector<std::uint8_t> spared = spared_groups(objects, world, parameters);
  for (std::size_t i = 0; i < objects.points.size(); ++i) {
    const auto cluster = static_cast<std::size_t>(objects.number[i]);
    Evidence& verdict = world.verdict[objects.points[i]];
    const bool mostly_dynamic =
        objects.dynamic[cluster] >= parameters.object_dynamic_share * objects.size[cluster] &&
        objects.dynamic[cluster] >=
            (objects.is_part[cluster] != 0 ? parameters.group_points : parameters.object_points);
    if (mostly_dynamic || marks[cluster] != 0) {
      verdict = Evidence::kDynamic;
    } else if (spared[i] == 0 && objects.is_hardly_dynamic[cluster] != 0) {
      verdict = Evidence::kStatic;
    }
  }
}

void judge_low_points(const RaymovalPlusParameters& parameters, WorldScan& world) {
  constexpr float kHighest = 1.0F;  // Metres: what is above does not stand on these points.
  struct Standing {
    int dynamic = 0, fixed = 0;
  };
  VoxelMap<Standing> columns;
  const double scale = 1.0 / parameters.voxel_size;
  const auto low = static_cast<float>(parameters.object_height);
  for (std::size_t k = 0; k < world.points.size(); ++k) {
    if (!(world.height[k] >= low) || world.height[k] >= kHighest) continue;
    const VoxelIndex at = voxel_index(world.points[k], scale);
    Standing& standing = columns[voxel_key(at.x(), at.y(), 0)];
    ++(world.verdict[k] == Evidence::kDynamic ? standing.dynamic : standing.fixed);
  }
  const auto around = [&](const VoxelIndex& at) {
    Standing sum;
    for (int n = 0; n < 9; ++n) {
      const auto found = columns.find(voxel_key(at.x() + n % 3 - 1, at.y() + n / 3 - 1, 0));
      if (found == columns.end()) continue;
      sum.dynamic += found->second.dynamic;
      sum.fixed += found->second.fixed;
    }
    return sum;
  };
  VoxelIndex last(0, 0, 0);
  Standing sum = around(last);
  for (std::size_t k = 0; k < world.points.size(); ++k) {
    if (world.voxel[k] == EvidenceMap::kNone || !(world.height[k] < low)) continue;
    const VoxelIndex at = voxel_index(world.points[k], scale);
    // The next point is mostly beside this one.
    if (at.x() != last.x() || at.y() != last.y()) sum = around(at);
    last = at;
    if (sum.dynamic > 0 && sum.dynamic >= 2 * sum.fixed) {
      world.verdict[k] = Evidence::kDynamic;
    } else if (sum.fixed > 0 && sum.fixed >= 2 * sum.dynamic) {
      world.verdict[k] = Evidence::kStatic;
    }
  }
}

}  // namespace raymoval
