// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/online/recent_objects.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// A post of 20 points, 1.9 m high and 0.2 m wide, that drives off by 1.5 m per scan, at 15 m/s.
/// Its places are unknown at first; later scans pass the places that it left.
class DrivingPost {
 public:
  explicit DrivingPost(int recent_scans = 30)
      : parameters_{.recent_scans = recent_scans}, recent_(parameters_) {}

  /// A scan of the post. A pole aside comes first: it is cluster 0.
  void scan(std::size_t index, bool with_pole = false) {
    SegmentedScan scan;
    scan.scan.index = index;
    scan.scan.time_s = 0.1 * static_cast<double>(index);
    for (int k = 0; k < 6 && with_pole; ++k) add({5.05, 12.05, 0.4 + 0.1 * k}, scan);
    for (int k = 0; k < kPoints; ++k) add(place(index, k), scan);
    find_clusters(parameters_, RunContext{}, scan);
    add_evidence_of_points(in_map_.map, scan);
    recent_.take(scan, in_map_.map, RunContext{});
    std::vector<std::uint32_t> blocks{in_map_.map.block_of(scan.voxel[0])};
    recent_.add_blocks(in_map_.map, blocks);
    std::sort(blocks.begin(), blocks.end());
    CHECK(std::adjacent_find(blocks.begin(), blocks.end()) == blocks.end());  // Each once.
    for (const std::uint32_t voxel : scan.voxel) {
      CHECK(std::binary_search(blocks.begin(), blocks.end(), in_map_.map.block_of(voxel)));
    }
  }
  /// Later scans passed the place of a scan's post.
  void leave(std::size_t scan) {
    for (int k = 0; k < kPoints; ++k) {
      in_map_.map.evidence(in_map_.find(place(scan, k))).passes_outside = 1.0F;
    }
  }
  /// The marked clusters of a scan, by the present evidence.
  [[nodiscard]] std::vector<int> marked(std::size_t scan) {
    recent_.judge(in_map_.map, RunContext{});
    return recent_.marked(scan, RunContext{});
  }
  /// Whether the post of a scan is marked, which is then answered.
  [[nodiscard]] bool is_marked(std::size_t scan) {
    const bool is_marked = marked(scan) == std::vector{0};
    recent_.forget_before(scan + 1);
    return is_marked;
  }

 private:
  static constexpr int kPoints = 20;
  static Eigen::Vector3d place(std::size_t scan, int k) {
    return {5.05 + 1.5 * static_cast<double>(scan), 0.05 + 0.2 * (k % 2), 0.4 + 0.1 * k};
  }
  void add(const Eigen::Vector3d& point, SegmentedScan& scan) {
    scan.voxel.push_back(in_map_.add(point));
    VoxelEvidence& evidence = in_map_.map.evidence(scan.voxel.back());
    if (evidence.hits == 0) add_observation(Observation::kHit, scan.scan.index, evidence);
    scan.scan.points.push_back(point.cast<float>());
    scan.height.push_back(static_cast<float>(point.z()));
    scan.verdict.push_back(Verdict::kUndecided);
  }

  Parameters parameters_;
  MapPoints in_map_;
  RecentObjects recent_;
};

}  // namespace

TEST_CASE("what left three places behind is known to move, in a place of which nothing is known") {
  DrivingPost post;
  for (std::size_t i = 0; i < 6; ++i) {
    post.scan(i);
    if (i >= 2) post.leave(i - 2);
    // Three places are left when scan 4 comes.
    CHECK(post.is_marked(i) == (i >= 4));
  }
}

TEST_CASE("what left three places behind later is known to have moved before") {
  // No track from before leads to the first scan. A track needs three dynamic objects.
  for (const std::size_t left : {2U, 3U}) {
    DrivingPost post;
    for (std::size_t i = 0; i < 5; ++i) post.scan(i);
    for (std::size_t k = 0; k < left; ++k) post.leave(4 - k);
    CHECK(post.is_marked(0) == (left == 3));
  }
}

TEST_CASE("the clusters of a scan that is taken again replace those that it had") {
  // The post is cluster 0, or cluster 1 if there is a pole, which is kept.
  DrivingPost post;
  for (std::size_t i = 0; i < 5; ++i) post.scan(i);
  for (const std::size_t i : {0U, 1U, 2U}) post.leave(i);
  CHECK(post.marked(4) == std::vector{0});
  for (const std::size_t i : {1U, 4U}) post.scan(i, true);
  CHECK(post.marked(4) == std::vector{1});
}

TEST_CASE("what was judged last holds for objects that are no longer recent") {
  DrivingPost late(1), post(2);
  for (std::size_t i = 0; i < 12; ++i) {
    for (DrivingPost* const some : {&late, &post}) {
      some->scan(i);
      if (i >= 2) some->leave(i - 2);
    }
    CHECK_FALSE(late.is_marked(i));        // Forgotten before it left anything.
    CHECK(post.is_marked(i) == (i >= 4));  // Its track reaches the first place.
  }
}

}  // namespace raymoval::raymoval_plus_test
