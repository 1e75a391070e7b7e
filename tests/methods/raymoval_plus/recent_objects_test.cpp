// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/online/recent_objects.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/methods/raymoval_plus/map_points.h"

using namespace raymoval;
using namespace raymoval::raymoval_plus_method;

namespace {

/// A post of 20 points, 1.9 m high and 0.2 m wide, that drives off by 1.5 m a scan, at 15 m/s.
/// Nothing is known of where it stands; it is seen later that nothing is left where it stood.
class DrivingPost {
 public:
  explicit DrivingPost(int recent_scans = 30, const DirectionSteps& steps = {})
      : recent_(with_recent_scans(recent_scans), steps) {}

  /// The post in its next place.
  void scan() {
    SegmentedScan scan;
    scan.scan.index = voxels_.size();
    scan.scan.time_s = 0.1 * static_cast<double>(scan.scan.index);
    voxels_.emplace_back();
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d point(5.05 + 1.5 * static_cast<double>(scan.scan.index),
                                  0.05 + 0.2 * (k % 2), 0.4 + 0.1 * k);
      const std::uint32_t voxel = in_map_.add(point);
      in_map_.map.evidence(voxel).agree_scans = 1;
      scan.scan.points.push_back(point.cast<float>());
      scan.height.push_back(static_cast<float>(point.z()));
      scan.voxel.push_back(voxel);
      scan.verdict.push_back(Verdict::kUndecided);
      voxels_.back().push_back(voxel);
    }
    find_clusters(Parameters{}, RunContext{}, scan);
    count_points(scan);
    recent_.take(scan, in_map_.map, RunContext{});
  }
  /// Later scans saw through the place of a scan's post.
  void leave(std::size_t scan) {
    for (const std::uint32_t voxel : voxels_[scan]) {
      EvidenceMap::Blocks::Cursor cursor;
      EvidenceMap& map = in_map_.map;
      map.set_verdict_in(map.find_slot(map.index(voxel), cursor), Verdict::kDynamic);
    }
  }
  /// Whether the post of a scan is marked, by what is known now.
  [[nodiscard]] bool is_marked(std::size_t scan) {
    recent_.judge(in_map_.map, RunContext{});
    const bool marked = recent_.marked(scan, RunContext{}) == std::vector{0};
    recent_.forget_before(scan + 1);
    return marked;
  }

 private:
  static Parameters with_recent_scans(int scans) {
    Parameters parameters;
    parameters.recent_scans = scans;
    return parameters;
  }
  toy::MapPoints in_map_;
  std::vector<std::vector<std::uint32_t>> voxels_;  ///< By scan.
  RecentObjects recent_;
};

}  // namespace

TEST_CASE("what left three places behind is known to move, in a place of which nothing is known") {
  DrivingPost post;
  for (std::size_t i = 0; i < 6; ++i) {
    post.scan();
    if (i >= 2) post.leave(i - 2);
    // Three places are left when scan 4 comes.
    CHECK(post.is_marked(i) == (i >= 4));
  }
}

TEST_CASE("what has far fewer points than a surface of its size is not followed") {
  // In the nearest place its 0.38 m^2 are 32 directions 0.02 apart, and 12900 0.001 apart. In the
  // farthest they are 6 and 2400.
  for (const float step : {0.02F, 0.001F}) {
    DrivingPost post(30, {step, step});
    for (std::size_t i = 0; i < 6; ++i) {
      post.scan();
      if (i >= 2) post.leave(i - 2);
      CHECK(post.is_marked(i) == (i >= 4 && step > 0.01F));
    }
  }
}

TEST_CASE("what left nothing behind is not known to move") {
  DrivingPost post;
  for (std::size_t i = 0; i < 6; ++i) {
    post.scan();
    CHECK_FALSE(post.is_marked(i));
  }
}

TEST_CASE("what was judged last holds for objects that are no longer recent") {
  DrivingPost late(1), post(2);
  for (std::size_t i = 0; i < 12; ++i) {
    for (DrivingPost* const some : {&late, &post}) {
      some->scan();
      if (i >= 2) some->leave(i - 2);
    }
    CHECK_FALSE(late.is_marked(i));        // Forgotten before it left anything.
    CHECK(post.is_marked(i) == (i >= 4));  // Its track goes back to the first place.
  }
}

TEST_CASE("the blocks of recent objects are added once") {
  toy::MapPoints in_map;
  SegmentedScan scan;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d point(5.05, 0.05, 0.45 + 0.2 * k);  // Blocks are 0.8 m high.
    scan.scan.points.push_back(point.cast<float>());
    scan.height.push_back(static_cast<float>(point.z()));
    scan.voxel.push_back(in_map.add(point));
    scan.verdict.push_back(Verdict::kStatic);
  }
  find_clusters(Parameters{}, RunContext{}, scan);
  count_points(scan);
  RecentObjects recent{Parameters{}};
  recent.take(scan, in_map.map, RunContext{});
  std::vector<std::uint32_t> blocks{in_map.map.block_of(scan.voxel[0])};
  recent.add_blocks(in_map.map, blocks);
  CHECK(blocks.size() == in_map.map.blocks().block_count());
  std::sort(blocks.begin(), blocks.end());
  CHECK(std::adjacent_find(blocks.begin(), blocks.end()) == blocks.end());
}
