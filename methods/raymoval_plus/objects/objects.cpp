// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/objects.h"

#include <algorithm>

#include "core/parallel.h"
#include "methods/common/range_adaptive_clusters.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of step 8; EXPERIMENTS.md has each at half and at double its value.
/// What is higher than so many metres does not stand on the points near the ground: legs and wheels
/// end below, tree tops and awnings do not.
constexpr float kHighest = 1.0F;
/// Points near the ground follow the dynamic points above them if these are so many times the
/// others, and the other way round. Between, they stay what their voxels are.
constexpr int kMajority = 2;

/// The number of scans that agree with a point's voxel; 0 for ground.
int agreeing_scans(const EvidenceMap& map, std::uint32_t voxel) {
  return voxel == EvidenceMap::kNone ? 0 : map.evidence(voxel).agree_scans;
}

/// The cluster of each of the `chosen` points of a scan.
std::vector<int> clusters_of(const Scan& scan, const std::vector<std::size_t>& chosen,
                             const Parameters& parameters) {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> ranges;
  for (const std::size_t k : chosen) {
    points.push_back(scan.points[k]);
    ranges.push_back(scan.points[k].norm());
  }
  return range_adaptive_clusters(points, ranges, static_cast<float>(parameters.cluster_gap),
                                 static_cast<float>(parameters.cluster_growth));
}

/// Clusters some of the `high_points` among themselves. The result is the number of each one's new
/// cluster, or -1 if `choose(point, cluster)` does not want it.
template <class Choose>
std::vector<int> clusters_among(const SegmentedScan& scan, const Parameters& parameters,
                                Choose&& choose) {
  std::vector<std::size_t> places, chosen;
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const std::size_t k = scan.high_points[i];
    if (!choose(k, scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])])) continue;
    places.push_back(i);
    chosen.push_back(k);
  }
  const std::vector<int> clusters = clusters_of(scan.scan, chosen, parameters);
  std::vector<int> among(scan.high_points.size(), -1);
  for (std::size_t n = 0; n < places.size(); ++n) among[places[n]] = clusters[n];
  return among;
}

void count_points(SegmentedScan& scan) {
  for (Cluster& cluster : scan.clusters) cluster.points = cluster.dynamic = 0;
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    Cluster& cluster = scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])];
    ++cluster.points;
    if (scan.verdict[scan.high_points[i]] == Verdict::kDynamic) ++cluster.dynamic;
  }
}

bool is_mostly_dynamic(const Cluster& cluster, const Parameters& parameters) {
  return cluster.dynamic >= parameters.object_dynamic_share * cluster.points;
}

/// Divides the clusters that have many dynamic points, but are not mostly dynamic.
void divide_mixed_clusters(const EvidenceMap& map, const Parameters& parameters,
                           SegmentedScan& scan) {
  const auto is_left_over = [&](std::size_t k, const Cluster& cluster) {
    if (cluster.dynamic < parameters.group_points || is_mostly_dynamic(cluster, parameters)) {
      return false;
    }
    return scan.verdict[k] == Verdict::kDynamic ||
           agreeing_scans(map, scan.voxel[k]) < parameters.settled_scans;
  };
  const std::vector<int> parts = clusters_among(scan, parameters, is_left_over);
  const std::size_t whole_clusters = scan.clusters.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] < 0) continue;
    const std::size_t number = whole_clusters + static_cast<std::size_t>(parts[i]);
    if (number >= scan.clusters.size()) scan.clusters.resize(number + 1);
    scan.clusters[number].is_part = true;
    scan.clusters[number].is_hardly_dynamic =
        scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])].is_hardly_dynamic;
    scan.cluster_of[i] = static_cast<int>(number);
  }
  count_points(scan);
}

/// The dynamic points of hardly dynamic clusters that hang together with enough others: 1 for each
/// of `high_points` that is one.
std::vector<std::uint8_t> spared_groups(const SegmentedScan& scan, const Parameters& parameters) {
  const auto may_be_spared = [&](std::size_t k, const Cluster& cluster) {
    return scan.verdict[k] == Verdict::kDynamic && cluster.is_hardly_dynamic;
  };
  const std::vector<int> groups = clusters_among(scan, parameters, may_be_spared);
  std::vector<int> size(groups.size(), 0);
  for (const int group : groups) {
    if (group >= 0) ++size[static_cast<std::size_t>(group)];
  }
  std::vector<std::uint8_t> spared(groups.size(), 0);
  for (std::size_t i = 0; i < spared.size(); ++i) {
    if (groups[i] < 0) continue;
    spared[i] = size[static_cast<std::size_t>(groups[i])] >= parameters.group_points ? 1 : 0;
  }
  return spared;
}

/// The numbers of points that stand in a column of voxels, or in one and the eight around it.
struct Standing {
  int dynamic = 0, fixed = 0;
};
using Columns = VoxelMap<Standing>;

Standing standing_around(const Columns& columns, const VoxelIndex& at) {
  Standing sum;
  for (int n = 0; n < 9; ++n) {
    const auto found = columns.find(voxel_key(at.x() + n % 3 - 1, at.y() + n / 3 - 1, 0));
    if (found == columns.end()) continue;
    sum.dynamic += found->second.dynamic;
    sum.fixed += found->second.fixed;
  }
  return sum;
}

Verdicts verdicts_of_voxels(const LocatedScan& scan, const EvidenceMap& map,
                            const RunContext& context) {
  const StageScope timed(context.times, "verdicts");
  Verdicts verdicts(scan.voxel.size());
  parallel_for(context.threads, verdicts.size(), kPointsATask, [&](std::size_t k) {
    // Ground has no voxel. Nor has a point that was ground when its scan was added, and is not
    // after the terrain was found anew.
    const std::uint32_t voxel = scan.voxel[k];
    verdicts[k] = voxel == EvidenceMap::kNone ? Verdict::kStatic : map.verdict(voxel);
  });
  return verdicts;
}

}  // namespace

SegmentedScan find_objects(LocatedScan scan, const EvidenceMap& map, const Parameters& parameters,
                           const RunContext& context) {
  Verdicts verdicts = verdicts_of_voxels(scan, map, context);
  SegmentedScan segmented{std::move(scan), std::move(verdicts), {}, {}, {}};
  if (!parameters.objects) return segmented;
  const StageScope timed(context.times, "objects");
  const auto farthest = static_cast<float>(parameters.evidence_range_max);
  for (std::size_t k = 0; k < segmented.points.size(); ++k) {
    if (segmented.height[k] < static_cast<float>(parameters.object_height)) continue;
    if (segmented.scan.points[k].squaredNorm() > farthest * farthest) continue;
    segmented.high_points.push_back(k);
  }
  segmented.cluster_of = clusters_of(segmented.scan, segmented.high_points, parameters);
  const auto& number = segmented.cluster_of;
  segmented.clusters.resize(number.empty() ? 0
                                           : 1 + *std::max_element(number.begin(), number.end()));
  count_points(segmented);
  for (Cluster& cluster : segmented.clusters) {
    cluster.is_hardly_dynamic = cluster.dynamic <= parameters.object_static_share * cluster.points;
  }
  if (parameters.settled_scans > 0) divide_mixed_clusters(map, parameters, segmented);
  return segmented;
}

std::vector<ObjectSummary> summarise_objects(const SegmentedScan& scan, const EvidenceMap& map,
                                             const Parameters& parameters,
                                             const RunContext& context) {
  if (!parameters.objects || !parameters.tracks) return {};
  const StageScope timed(context.times, "objects");
  std::vector<ObjectSummary> objects(scan.clusters.size());
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const std::size_t k = scan.high_points[i];
    ObjectSummary& object = objects[static_cast<std::size_t>(scan.cluster_of[i])];
    object.low = object.low.cwiseMin(scan.points[k]);
    object.high = object.high.cwiseMax(scan.points[k]);
    object.center += scan.points[k];
    if (scan.verdict[k] != Verdict::kDynamic) {
      object.agree_scans += static_cast<float>(agreeing_scans(map, scan.voxel[k]));
    }
  }
  const Eigen::Vector3d sensor = scan.scan.T_world_sensor.translation();
  std::vector<ObjectSummary> followed;
  for (std::size_t c = 0; c < objects.size(); ++c) {
    ObjectSummary& object = objects[c];
    object.points = scan.clusters[c].points;
    object.dynamic = scan.clusters[c].dynamic;
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

Verdicts decide_objects(const SegmentedScan& scan, const std::vector<int>& marked,
                        const Parameters& parameters, const RunContext& context) {
  if (!parameters.objects) return scan.verdict;
  const StageScope timed(context.times, "objects");
  std::vector<std::uint8_t> marks(scan.clusters.size(), 0);
  for (const int cluster : marked) marks[static_cast<std::size_t>(cluster)] = 1;
  const std::vector<std::uint8_t> spared = spared_groups(scan, parameters);
  Verdicts verdict = scan.verdict;
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const auto number = static_cast<std::size_t>(scan.cluster_of[i]);
    const Cluster& cluster = scan.clusters[number];
    const int enough = cluster.is_part ? parameters.group_points : parameters.object_points;
    if (marks[number] != 0 ||
        (is_mostly_dynamic(cluster, parameters) && cluster.dynamic >= enough)) {
      verdict[scan.high_points[i]] = Verdict::kDynamic;
    } else if (spared[i] == 0 && cluster.is_hardly_dynamic) {
      verdict[scan.high_points[i]] = Verdict::kStatic;
    }
  }
  return verdict;
}

Verdicts decide_low_points(const LocatedScan& scan, Verdicts verdict, const Parameters& parameters,
                           const RunContext& context) {
  if (!parameters.low_points || !parameters.terrain) return verdict;
  const StageScope timed(context.times, "low points");
  const double scale = 1.0 / parameters.voxel_size;
  const auto low = static_cast<float>(parameters.object_height);
  Columns columns;
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    if (scan.height[k] < low || scan.height[k] >= kHighest) continue;
    const VoxelIndex at = voxel_index(scan.points[k], scale);
    Standing& standing = columns[voxel_key(at.x(), at.y(), 0)];
    ++(verdict[k] == Verdict::kDynamic ? standing.dynamic : standing.fixed);
  }
  VoxelIndex last(0, 0, 0);
  Standing around = standing_around(columns, last);
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    if (scan.voxel[k] == EvidenceMap::kNone || scan.height[k] >= low) continue;
    const VoxelIndex at = voxel_index(scan.points[k], scale);
    // The next point mostly lies in the same column.
    if (at.x() != last.x() || at.y() != last.y()) around = standing_around(columns, at);
    last = at;
    if (around.dynamic > 0 && around.dynamic >= kMajority * around.fixed) {
      verdict[k] = Verdict::kDynamic;
    } else if (around.fixed > 0 && around.fixed >= kMajority * around.dynamic) {
      verdict[k] = Verdict::kStatic;
    }
  }
  return verdict;
}

}  // namespace raymoval::raymoval_plus_method
