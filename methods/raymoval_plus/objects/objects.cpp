// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/objects.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "methods/common/range_adaptive_clusters.h"
#include "methods/raymoval_plus/evidence/evidence.h"
#include "methods/raymoval_plus/evidence/things.h"
#include "methods/raymoval_plus/objects/fragments.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Of each cluster one of so many points is looked at first, to find those that are too wide.
constexpr std::size_t kFewPoints = 8;
/// A cluster of which no larger share of the points is dynamic is static.
constexpr double kHardlyDynamic = 0.1;
/// A point stands if so many scans hit its voxel, and fewer passes than this a voxel tell that the
/// thing there came or left. If this share of a dynamic cluster stands, it is a thing beside
/// another.
constexpr int kStandingHits = 10;
constexpr float kStandingPasses = 0.2F;
constexpr double kStandingShare = 0.5;
/// A static cluster of so many points may hold something that moves: points that are dynamic and
/// with them so many passes a voxel.
constexpr int kLargeCluster = 1000;
constexpr float kMovingPasses = 2.0F;

/// Calls `visit(point, cluster)` for each point that is in a cluster.
template <class Visit>
void for_clustered_points(const SegmentedScan& scan, Visit&& visit) {
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    visit(scan.high_points[i], static_cast<std::size_t>(scan.cluster_of[i]));
  }
}

/// The cluster of each of the `chosen` points of a scan.
std::vector<int> clusters_of(const Scan& scan, const std::vector<std::uint32_t>& chosen,
                             const Parameters& parameters) {
  thread_local std::vector<Eigen::Vector3f> points;
  thread_local std::vector<float> ranges;
  points.resize(chosen.size());
  ranges.resize(chosen.size());
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    points[n] = scan.points[chosen[n]];
    ranges[n] = points[n].norm();
  }
  return range_adaptive_clusters(points, ranges, static_cast<float>(parameters.cluster_gap),
                                 static_cast<float>(parameters.cluster_growth));
}

/// Grows the box of an object.
void add_to_box(const Eigen::Vector3d& point, ObjectSummary& object) {
  object.low = object.low.cwiseMin(point);
  object.high = object.high.cwiseMax(point);
}

/// Adds the hits of a point's voxel to the sums of an object.
void add_hits(std::uint32_t k, const SegmentedScan& scan, const EvidenceMap& map,
              ObjectSummary& object) {
  VoxelEvidence evidence;
  if (scan.has_standing_voxel(k)) evidence = map.evidence(scan.voxel[k]);
  object.hits += evidence.hits;
  const auto [first, last] = hit_span(evidence, scan.scan.index);
  object.first_hit += first;
  object.last_hit += last;
}

/// Makes means of the sums.
/// @param points those whose hits were added; without any, the object is hit by its scan
void divide_sums(int points, std::size_t scan, ObjectSummary& object) {
  object.center /= object.points;
  if (points == 0) {
    object.hits = 1.0F;
    object.first_hit = object.last_hit = static_cast<double>(scan);
    return;
  }
  object.hits /= static_cast<float>(points);
  object.first_hit /= points;
  object.last_hit /= points;
}

/// The clusters that may be followed: 1 for each that is neither too small nor, by a few of its
/// points, too wide. Most points of a scan are of houses and trees, which that leaves out.
std::vector<std::uint8_t> clusters_to_follow(const SegmentedScan& scan,
                                             const Parameters& parameters) {
  std::vector<ObjectSummary> boxes(scan.clusters.size());
  for (std::size_t i = 0; i < scan.high_points.size(); i += kFewPoints) {
    add_to_box(scan.world(scan.high_points[i]),
               boxes[static_cast<std::size_t>(scan.cluster_of[i])]);
  }
  std::vector<std::uint8_t> follow(boxes.size());
  for (std::size_t c = 0; c < follow.size(); ++c) {
    const bool too_wide = boxes[c].low.x() <= boxes[c].high.x() &&  // It has any of the points.
                          boxes[c].width() > parameters.track_width;
    follow[c] = scan.clusters[c].points >= parameters.track_points && !too_wide ? 1 : 0;
  }
  return follow;
}

/// Where clusters join what moves to what stands: points of the other thing.
class OtherThings {
 public:
  OtherThings(const SegmentedScan& scan, const EvidenceMap& map)
      : scan_(scan), map_(map), around_(map.voxel_size()) {}

  /// The points of what stands beside things that go.
  /// @param go 1 for each cluster that goes
  [[nodiscard]] std::vector<std::uint32_t> standing_beside(const std::vector<std::uint8_t>& go) {
    std::vector<std::pair<std::uint32_t, std::size_t>> found;
    std::vector<int> count(go.size(), 0);
    for_clustered_points(scan_, [&](std::uint32_t k, std::size_t cluster) {
      if (go[cluster] == 0 || !stands(k)) return;
      found.emplace_back(k, cluster);
      ++count[cluster];
    });
    std::vector<std::uint32_t> points;
    for (const auto& [k, cluster] : found) {
      if (count[cluster] >= kStandingShare * scan_.clusters[cluster].points) points.push_back(k);
    }
    return points;
  }
  /// Whether a point of a static cluster is of something that moves.
  [[nodiscard]] bool moves(std::uint32_t k, const Cluster& cluster) {
    return cluster.points >= kLargeCluster && scan_.verdict[k] == Verdict::kDynamic &&
           scan_.has_standing_voxel(k) && passes_of_thing(k) >= kMovingPasses;
  }

 private:
  [[nodiscard]] bool stands(std::uint32_t k) {
    if (!scan_.has_standing_voxel(k)) return false;
    const VoxelEvidence& evidence = map_.evidence(scan_.voxel[k]);
    return evidence.hits >= kStandingHits && evidence.passes_outside < 1.0F &&
           passes_of_thing(k) < kStandingPasses;
  }
  [[nodiscard]] float passes_of_thing(std::uint32_t k) {
    around_.look_at(map_.block_of(scan_.voxel[k]), map_);
    return around_.passes_of_thing(map_.index(scan_.voxel[k]), map_);
  }

  const SegmentedScan& scan_;
  const EvidenceMap& map_;
  Surroundings around_;
};

/// Lets fragments go with what goes beside them.
/// @param go 1 for each cluster that goes
void add_fragments(const SegmentedScan& scan, const std::vector<std::uint8_t>& go,
                   const Parameters& parameters, Verdicts& verdict) {
  if (std::find(go.begin(), go.end(), 1) == go.end()) return;
  std::vector<ObjectSummary> boxes(go.size());
  for_clustered_points(scan, [&](std::uint32_t k, std::size_t cluster) {
    if (go[cluster] != 0) add_to_box(scan.world(k), boxes[cluster]);
  });
  const Fragments fragments(scan, parameters);
  for (std::size_t c = 0; c < go.size(); ++c) {
    if (go[c] == 0 || is_fragment(scan.clusters[c].points, parameters)) continue;
    if (boxes[c].width() > parameters.track_width) continue;
    fragments.for_near(boxes[c], [&](std::uint32_t k) { verdict[k] = Verdict::kDynamic; });
  }
}

}  // namespace

void find_clusters(const Parameters& parameters, const RunContext& context, SegmentedScan& scan) {
  scan.high_points.clear();
  scan.cluster_of.clear();
  scan.clusters.clear();
  if (!parameters.objects) return;
  const StageScope timed(context.times, "objects");
  const auto farthest = static_cast<float>(parameters.evidence_range_max);
  const auto low = static_cast<float>(parameters.object_height);
  for (std::size_t k = 0; k < scan.scan.size(); ++k) {
    if (scan.height[k] < low) continue;
    if (scan.scan.points[k].squaredNorm() > farthest * farthest) continue;
    scan.high_points.push_back(static_cast<std::uint32_t>(k));
  }
  scan.cluster_of = clusters_of(scan.scan, scan.high_points, parameters);
  const auto& number = scan.cluster_of;
  scan.clusters.resize(number.empty() ? 0 : 1 + *std::max_element(number.begin(), number.end()));
}

void add_evidence_of(std::uint32_t voxel, std::uint32_t points, const EvidenceMap& map,
                     ObjectEvidence& sum) {
  const VoxelEvidence& evidence = map.evidence(voxel);
  const auto many = static_cast<float>(points);
  if (map.verdict(voxel) == Verdict::kDynamic) sum.dynamic += static_cast<int>(points);
  sum.contradiction += many * contradiction(evidence);
  sum.passes += many * evidence.passes_outside;
}

void add_evidence_of_points(const EvidenceMap& map, SegmentedScan& scan) {
  for (Cluster& cluster : scan.clusters) cluster = {};
  for_clustered_points(scan, [&](std::uint32_t k, std::size_t number) {
    Cluster& cluster = scan.clusters[number];
    ++cluster.points;
    if (scan.has_standing_voxel(k)) add_evidence_of(scan.voxel[k], 1, map, cluster.evidence);
  });
}

std::vector<ObjectSummary> summarise_objects(const SegmentedScan& scan, const EvidenceMap& map,
                                             const Parameters& parameters,
                                             const RunContext& context) {
  if (!parameters.objects || !parameters.tracks) return {};
  const StageScope timed(context.times, "objects");
  std::vector<ObjectSummary> objects(scan.clusters.size());
  const std::vector<std::uint8_t> follow = clusters_to_follow(scan, parameters);
  for_clustered_points(scan, [&](std::uint32_t k, std::size_t cluster) {
    if (follow[cluster] == 0) return;
    ObjectSummary& object = objects[cluster];
    const Eigen::Vector3d point = scan.world(k);
    add_to_box(point, object);
    object.center += point;
    if (scan.verdict[k] != Verdict::kDynamic) add_hits(k, scan, map, object);
  });
  const Eigen::Vector3d sensor = scan.scan.T_world_sensor.translation();
  std::vector<ObjectSummary> followed;
  for (std::size_t c = 0; c < objects.size(); ++c) {
    ObjectSummary& object = objects[c];
    if (follow[c] == 0 || object.width() > parameters.track_width) continue;
    object.points = scan.clusters[c].points;
    object.evidence = scan.clusters[c].evidence;
    divide_sums(object.points - object.evidence.dynamic, scan.scan.index, object);
    object.time_s = scan.scan.time_s;
    object.range = static_cast<float>((object.center - sensor).norm());
    object.cluster = static_cast<int>(c);
    followed.push_back(object);
  }
  return followed;
}

Verdicts decide_objects(const SegmentedScan& scan, const std::vector<int>& marked,
                        const EvidenceMap& map, const Parameters& parameters,
                        const RunContext& context) {
  if (!parameters.objects) return scan.verdict;
  const StageScope timed(context.times, "objects");
  std::vector<std::uint8_t> go(scan.clusters.size(), 0), stay(scan.clusters.size(), 0);
  for (std::size_t c = 0; c < go.size(); ++c) {
    const Cluster& cluster = scan.clusters[c];
    go[c] = is_dynamic(cluster, parameters) ? 1 : 0;
    stay[c] = cluster.evidence.dynamic <= kHardlyDynamic * cluster.points ? 1 : 0;
  }
  for (const int cluster : marked) go[static_cast<std::size_t>(cluster)] = 1;
  OtherThings others(scan, map);
  Verdicts verdict = scan.verdict;
  for_clustered_points(scan, [&](std::uint32_t k, std::size_t cluster) {
    if (go[cluster] != 0) {
      verdict[k] = Verdict::kDynamic;
    } else if (stay[cluster] != 0 && !others.moves(k, scan.clusters[cluster])) {
      verdict[k] = Verdict::kStatic;
    }
  });
  for (const std::uint32_t k : others.standing_beside(go)) verdict[k] = Verdict::kStatic;
  add_fragments(scan, go, parameters, verdict);
  return verdict;
}

}  // namespace raymoval::raymoval_plus_method
