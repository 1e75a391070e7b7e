// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/objects.h"

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "core/parallel.h"
#include "methods/common/range_adaptive_clusters.h"
#include "methods/raymoval_plus/evidence/evidence.h"
#include "methods/raymoval_plus/objects/fragments.h"
#include "methods/raymoval_plus/objects/lasting_points.h"
#include "methods/raymoval_plus/objects/sparse_objects.h"
#include "methods/raymoval_plus/objects/whole_things.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Of each cluster one of so many points is looked at first, to find those that are too wide.
constexpr std::size_t kFewPoints = 8;

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

/// Clusters some of the `high_points` among themselves. The result is the number of each one's new
/// cluster, or -1 if `choose(point, cluster)` does not want it.
template <class Choose>
std::vector<int> clusters_among(const SegmentedScan& scan, const Parameters& parameters,
                                Choose&& choose) {
  std::vector<std::size_t> places;
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const std::uint32_t k = scan.high_points[i];
    if (!choose(k, scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])])) continue;
    places.push_back(i);
    chosen.push_back(k);
  }
  const std::vector<int> clusters = clusters_of(scan.scan, chosen, parameters);
  std::vector<int> among(scan.high_points.size(), -1);
  for (std::size_t n = 0; n < places.size(); ++n) among[places[n]] = clusters[n];
  return among;
}

/// Whether a cluster has many dynamic points, but too few to be one dynamic thing.
bool is_mixed(const Cluster& cluster, const Parameters& parameters) {
  if (getenv("NODIV") != nullptr) return false;
  if (is_one_dynamic_thing(cluster, parameters)) return false;
  return cluster.dynamic >= parameters.group_points ||
         static_cast<double>(cluster.score) >= parameters.object_score * cluster.points;
}

/// Finds the mixed clusters that are one thing.
void find_whole_clusters(const EvidenceMap& map, const Parameters& parameters,
                         SegmentedScan& scan) {
  std::vector<std::uint8_t> mixed(scan.clusters.size());
  for (std::size_t c = 0; c < mixed.size(); ++c) {
    mixed[c] = is_mixed(scan.clusters[c], parameters) ? 1 : 0;
  }
  const std::vector<std::uint8_t> is_whole = find_whole_things(scan, mixed, map, parameters);
  for (std::size_t c = 0; c < mixed.size(); ++c) scan.clusters[c].is_whole = is_whole[c] != 0;
}

/// Adds clusters that stand for what was divided, as it was before. What is hardly dynamic is no
/// one thing that moves, and has none.
/// @param whole the clusters before
/// @param divided for each part, which come after these, the cluster that it is from
void add_undivided(const std::vector<Cluster>& whole, const std::vector<std::size_t>& divided,
                   SegmentedScan& scan) {
  for (std::size_t part = 0; part < divided.size(); ++part) {
    const std::size_t from = divided[part];
    if (whole[from].is_hardly_dynamic || getenv("NOUNDIV") != nullptr) continue;
    if (scan.clusters[from].undivided < 0) {
      scan.clusters[from].undivided = static_cast<int>(scan.clusters.size());
      scan.clusters.push_back(
          {.points = whole[from].points, .dynamic = whole[from].dynamic,   .firm = whole[from].firm, .score = whole[from].score, .outside = whole[from].outside, .is_undivided = true});
    }
    scan.clusters[whole.size() + part].undivided = scan.clusters[from].undivided;
  }
}

/// Divides the mixed clusters.
void divide_mixed_clusters(const EvidenceMap& map, const Parameters& parameters,
                           SegmentedScan& scan) {
  const auto is_left_over = [&](std::size_t k, const Cluster& cluster) {
    if (!is_mixed(cluster, parameters)) return false;
    return scan.voxel[k] == EvidenceMap::kNone || !is_firm(map.evidence(scan.voxel[k]));
  };
  const std::vector<int> parts = clusters_among(scan, parameters, is_left_over);
  const std::vector<Cluster> whole = scan.clusters;
  std::vector<std::size_t> divided;  // The cluster that each part is from.
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] < 0) continue;
    const auto part = static_cast<std::size_t>(parts[i]);
    if (part >= divided.size()) divided.resize(part + 1);
    divided[part] = static_cast<std::size_t>(scan.cluster_of[i]);
    scan.cluster_of[i] = static_cast<int>(whole.size() + part);
  }
  for (const std::size_t from : divided) {
    scan.clusters.push_back({.is_part = true, .is_hardly_dynamic = whole[from].is_hardly_dynamic});
  }
  count_points(map, scan);
  add_undivided(whole, divided, scan);
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

/// Grows the box of an object.
void add_to_box(const Eigen::Vector3d& point, ObjectSummary& object) {
  object.low = object.low.cwiseMin(point);
  object.high = object.high.cwiseMax(point);
}

/// Adds what scans say of a point's voxel to the sums of an object.
void add_evidence_of(std::size_t k, const SegmentedScan& scan, const EvidenceMap& map,
                     ObjectSummary& object) {
  VoxelEvidence evidence;
  if (scan.voxel[k] != EvidenceMap::kNone) evidence = map.evidence(scan.voxel[k]);
  object.agree_scans += evidence.agree_scans;
  object.free_scans += evidence.free_scans;
  const auto [first, last] = agreeing_span(evidence, scan.scan.index);
  object.first_agree += first;
  object.last_agree += last;
}

/// Makes means of the sums.
void divide_evidence(int points, ObjectSummary& object) {
  object.agree_scans /= static_cast<float>(points);
  object.free_scans /= static_cast<float>(points);
  object.first_agree /= points;
  object.last_agree /= points;
}

/// The clusters that may be followed: 1 for each that is neither too small nor, by a few of its
/// points, too wide. Most points of a scan are of houses and trees, which that leaves out.
std::vector<std::uint8_t> clusters_to_follow(const SegmentedScan& scan,
                                             const Parameters& parameters) {
  std::vector<ObjectSummary> boxes(scan.clusters.size());
  for (std::size_t i = 0; i < scan.high_points.size(); i += kFewPoints) {
    const Eigen::Vector3d point = scan.world(scan.high_points[i]);
    for_clusters_of(scan, i, [&](std::size_t cluster) { add_to_box(point, boxes[cluster]); });
  }
  std::vector<std::uint8_t> follow(boxes.size());
  for (std::size_t c = 0; c < follow.size(); ++c) {
    const bool too_wide = boxes[c].low.x() <= boxes[c].high.x() &&  // It has any of the points.
                          boxes[c].width() > parameters.track_width;
    follow[c] = scan.clusters[c].points >= parameters.track_points && !too_wide ? 1 : 0;
  }
  return follow;
}

/// The clusters that a track marked: 1 for each that is one, or a part of one.
std::vector<std::uint8_t> marked_clusters(const SegmentedScan& scan,
                                          const std::vector<int>& marked) {
  std::vector<std::uint8_t> is_marked(scan.clusters.size(), 0);
  for (const int cluster : marked) is_marked[static_cast<std::size_t>(cluster)] = 1;
  for (std::size_t c = 0; c < is_marked.size(); ++c) {
    const int undivided = scan.clusters[c].undivided;
    if (undivided >= 0 && is_marked[static_cast<std::size_t>(undivided)] != 0) is_marked[c] = 1;
  }
  return is_marked;
}

/// The clusters that go by themselves: 1 for each that is one dynamic thing, and not marked. Parts
/// need more dynamic points, see `is_dynamic` of `ObjectSummary`.
std::vector<std::uint8_t> dynamic_clusters(const SegmentedScan& scan,
                                           const std::vector<std::uint8_t>& is_marked,
                                           const Parameters& parameters) {
  std::vector<std::uint8_t> go(scan.clusters.size(), 0);
  for (std::size_t c = 0; c < go.size(); ++c) {
    const Cluster& cluster = scan.clusters[c];
    const int enough = cluster.is_part ? parameters.group_points : parameters.object_points;
    go[c] = is_marked[c] == 0 && !cluster.is_undivided && cluster.points >= enough &&
            is_one_dynamic_thing(cluster, parameters);
  }
  return go;
}

/// Lets fragments go with what goes beside them.
/// @param go 1 for each cluster that goes
void add_fragments(const SegmentedScan& scan, const std::vector<std::uint8_t>& go,
                   const Parameters& parameters, Verdicts& verdict) {
  if (std::find(go.begin(), go.end(), 1) == go.end()) return;
  std::vector<ObjectSummary> boxes(go.size());
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    for_clusters_of(scan, i, [&](std::size_t cluster) {
      if (go[cluster] != 0) add_to_box(scan.world(scan.high_points[i]), boxes[cluster]);
    });
  }
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

void count_points(const EvidenceMap& map, SegmentedScan& scan) {
  for (Cluster& cluster : scan.clusters) {
    cluster.points = cluster.dynamic = cluster.firm = 0;
    cluster.score = cluster.outside = 0.0F;
  }
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    Cluster& cluster = scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])];
    ++cluster.points;
    const std::uint32_t k = scan.high_points[i];
    if (scan.verdict[k] == Verdict::kDynamic) ++cluster.dynamic;
    if (!scan.has_standing_voxel(k)) continue;
    const VoxelEvidence& evidence = map.evidence(scan.voxel[k]);
    cluster.score += contradiction(evidence);
    cluster.outside += std::max(evidence.score, 0.0F);
    if (is_firm(evidence)) ++cluster.firm;
  }
}

void divide_clusters(const EvidenceMap& map, const Parameters& parameters,
                     const RunContext& context, SegmentedScan& scan) {
  if (!parameters.objects) return;
  const StageScope timed(context.times, "objects");
  count_points(map, scan);
  for (Cluster& cluster : scan.clusters) {
    cluster.is_hardly_dynamic = cluster.dynamic <= parameters.object_static_share * cluster.points;
  }
  if (parameters.settled_scans == 0) return;
  if (parameters.whole) find_whole_clusters(map, parameters, scan);
  divide_mixed_clusters(map, parameters, scan);
}

std::vector<ObjectSummary> summarise_objects(const SegmentedScan& scan, const EvidenceMap& map,
                                             const DirectionSteps& steps,
                                             const Parameters& parameters,
                                             const RunContext& context) {
  if (!parameters.objects || !parameters.tracks) return {};
  const StageScope timed(context.times, "objects");
  std::vector<ObjectSummary> objects(scan.clusters.size());
  const std::vector<std::uint8_t> follow = clusters_to_follow(scan, parameters);
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const std::size_t k = scan.high_points[i];
    for_clusters_of(scan, i, [&](std::size_t cluster) {
      if (follow[cluster] == 0) return;
      ObjectSummary& object = objects[cluster];
      const Eigen::Vector3d point = scan.world(k);
      add_to_box(point, object);
      object.center += point;
      if (scan.verdict[k] != Verdict::kDynamic) add_evidence_of(k, scan, map, object);
    });
  }
  const Eigen::Vector3d sensor = scan.scan.T_world_sensor.translation();
  std::vector<ObjectSummary> followed;
  for (std::size_t c = 0; c < objects.size(); ++c) {
    ObjectSummary& object = objects[c];
    object.points = scan.clusters[c].points;
    object.dynamic = scan.clusters[c].dynamic;
    object.firm = scan.clusters[c].firm;
    object.score = scan.clusters[c].score;
    object.outside = scan.clusters[c].outside;
    object.is_part = scan.clusters[c].is_part;
    object.is_whole = scan.clusters[c].is_whole;
    object.is_undivided = scan.clusters[c].is_undivided;
    if (follow[c] == 0 || object.width() > parameters.track_width) continue;
    object.center /= object.points;
    object.time_s = scan.scan.time_s;
    object.range = static_cast<float>((object.center - sensor).norm());
    if (getenv("NOSPARSE") == nullptr && is_sparse(object, steps)) continue;
    divide_evidence(std::max(object.points - object.dynamic, 1), object);
    object.cluster = static_cast<int>(c);
    followed.push_back(object);
  }
  return followed;
}

Verdicts decide_objects(const SegmentedScan& scan, const EvidenceMap& map,
                        const std::vector<int>& marked, const Parameters& parameters,
                        const RunContext& context) {
  if (!parameters.objects) return scan.verdict;
  const StageScope timed(context.times, "objects");
  const std::vector<std::uint8_t> is_marked = marked_clusters(scan, marked);
  const std::vector<std::uint8_t> is_dynamic = dynamic_clusters(scan, is_marked, parameters);
  const std::vector<std::uint8_t> lasting = lasting_points(scan, map, is_dynamic, parameters);
  std::vector<std::uint8_t> spared = spared_groups(scan, parameters);
  if (getenv("NOSPARED") != nullptr) std::fill(spared.begin(), spared.end(), 0);
  if (getenv("ALLSPARED") != nullptr) std::fill(spared.begin(), spared.end(), 1);
  std::vector<std::uint8_t> go(is_marked.size());
  std::transform(is_marked.begin(), is_marked.end(), is_dynamic.begin(), go.begin(), std::bit_or());
  Verdicts verdict = scan.verdict;
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const auto number = static_cast<std::size_t>(scan.cluster_of[i]);
    const bool is_hardly_dynamic = scan.clusters[number].is_hardly_dynamic;
    if (go[number] != 0) {
      verdict[scan.high_points[i]] = parameters.lasting && lasting[i] != 0 ? Verdict::kStatic : Verdict::kDynamic;
    } else if (spared[i] == 0 && is_hardly_dynamic) {
      verdict[scan.high_points[i]] = Verdict::kStatic;
    }
  }
  if (getenv("NOFRAG") == nullptr) add_fragments(scan, go, parameters, verdict);
  return verdict;
}

}  // namespace raymoval::raymoval_plus_method
