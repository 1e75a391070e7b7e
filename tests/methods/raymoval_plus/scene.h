// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "methods/raymoval_plus/objects/low_points.h"
#include "methods/raymoval_plus/objects/objects.h"
#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {

/// A scan from the origin with given evidence and verdicts on the voxels of its points. The ground
/// is at height 0.
struct Scene {
  using Verdict = raymoval_plus_method::Verdict;
  using EvidenceMap = raymoval_plus_method::EvidenceMap;

  raymoval_plus_method::Parameters parameters;
  MapPoints in_map;
  EvidenceMap& map = in_map.map;
  raymoval_plus_method::EvidenceMaps maps{parameters};  ///< Only of the ground.
  raymoval_plus_method::LocatedScan scan;

  /// What is known of a voxel that was hit in all scans from `first` to `last`.
  struct Known {
    float passes_outside = 0.0F;
    std::uint32_t first = 0, last = 4;
    std::uint16_t passes_before = 0;
  };

  void add(const Eigen::Vector3d& point, Verdict verdict, const Known& known) {
    const std::uint32_t voxel = in_map.add(point);
    raymoval_plus_method::VoxelEvidence& evidence = map.evidence(voxel);
    evidence.hits = static_cast<std::uint16_t>(known.last - known.first + 1);
    evidence.first_hit = known.first;
    evidence.last_hit = known.last;
    evidence.passes_before = known.passes_before;
    evidence.passes_outside = known.passes_outside;
    map.set_decision(voxel, verdict);
    EvidenceMap::Blocks::Cursor cursor;
    map.set_verdict_in(map.find_slot(map.index(voxel), cursor), verdict);
    scan.in_map.x.push_back(map.index(voxel).x());
    scan.in_map.y.push_back(map.index(voxel).y());
    scan.in_map.z.push_back(map.index(voxel).z());
    scan.in_map.parts.push_back(MapPoint(point).parts);
    scan.scan.points.push_back(point.cast<float>());
    scan.height.push_back(static_cast<float>(point.z()));
    scan.voxel.push_back(voxel);
    scan.ground_voxel.push_back(EvidenceMap::kNone);
    scan.verdict.push_back(verdict);
  }
  /// A point that left if it is dynamic: four scans passed its place.
  void add(const Eigen::Vector3d& point, Verdict verdict) {
    add(point, verdict, {.passes_outside = verdict == Verdict::kDynamic ? 4.0F : 0.0F});
  }
  /// Adds what some scan saw of the ground to its map. @return the number of its voxel
  std::uint32_t see_ground(const Eigen::Vector3d& point) {
    const MapPoint at(point);
    EvidenceMap::Blocks::Cursor cursor;
    return maps.ground.add(raymoval_plus_method::ground_cell(at.cell),
                           raymoval_plus_method::ground_parts(at.cell, at.parts), cursor);
  }
  /// Adds a point that was taken for ground.
  void add_ground(const Eigen::Vector3d& point, Verdict verdict) {
    add(point, verdict);
    scan.voxel.back() = EvidenceMap::kNone;
    scan.ground_voxel.back() = see_ground(point);
  }
  /// Points in a column above (x, y), one in each voxel, from `low` metres upward.
  void add_column(double x, double y, double low, int points, Verdict verdict, const Known& known) {
    for (int k = 0; k < points; ++k) add({x, y, low + 0.2 * k}, verdict, known);
  }
  [[nodiscard]] raymoval_plus_method::SegmentedScan segmented() const {
    raymoval_plus_method::SegmentedScan segmented{scan, {}, {}, {}};
    find_clusters(parameters, RunContext{}, segmented);
    add_evidence_of_points(map, segmented);
    return segmented;
  }
  [[nodiscard]] std::vector<raymoval_plus_method::ObjectSummary> objects() const {
    return summarise_objects(segmented(), map, parameters, RunContext{});
  }
  /// The verdicts after step 8.
  [[nodiscard]] raymoval_plus_method::Verdicts with_low_points() const {
    raymoval_plus_method::Verdicts verdicts = scan.verdict;
    decide_low_points(scan, maps, parameters, RunContext{}, verdicts);
    return verdicts;
  }
  /// The number of dynamic points from number `first` to before `end`, after step 6.
  [[nodiscard]] int dynamic(int first, int end, const std::vector<int>& marked = {}) const {
    const auto verdicts = decide_objects(segmented(), marked, map, parameters, RunContext{});
    return static_cast<int>(
        std::count(verdicts.begin() + first, verdicts.begin() + end, Verdict::kDynamic));
  }
};

}  // namespace raymoval::raymoval_plus_test
