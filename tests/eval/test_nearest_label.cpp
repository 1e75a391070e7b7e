// SPDX-License-Identifier: MIT
// Which point gives a cell its label: the searched points, and ties.
#include <catch2/catch.hpp>

#include "eval/points/cell_neighbours.h"
#include "eval/points/labelled_voxels.h"
#include "eval/points/nearest_points.h"

namespace raymoval {

TEST_CASE("cells that the reach only touches are visited", "[voxels]") {
  // Cells of 0.5 m; the query is in the middle of its cell, 0.25 m from each wall.
  const Eigen::Vector3d query(5.25, 5.25, 5.25);
  for (const VoxelIndex& step : {VoxelIndex(1, 0, 0), VoxelIndex(0, 1, 0), VoxelIndex(0, 0, 1),
                                 VoxelIndex(-1, 0, 0), VoxelIndex(0, -1, 0)}) {
    const VoxelIndex cell = VoxelIndex(10, 10, 10) + step;
    const std::vector<VoxelKey> keys = {voxel_key(cell.x(), cell.y(), cell.z())};
    const auto visits = [&](double reach) {
      int visited = 0;
      CellNeighbours(keys, 0.5).visit(
          voxel_key(10, 10, 10), query, [&] { return reach; }, [&](std::size_t) { ++visited; });
      return visited;
    };
    CHECK(visits(0.25 + 5e-10) == 1);
    CHECK(visits(0.3) == 1);
    CHECK(visits(0.24) == 0);
  }
}

TEST_CASE("a point farther by just the margin is a tie, and the first index gives the label",
          "[voxels]") {
  const auto nobody_moves = [](std::uint32_t) { return false; };
  const double margin = kLabelTieMargin;
  LabelVote vote;
  vote.offer(0.0, 5);
  vote.offer(margin * margin, 3);
  CHECK(vote.decide(nobody_moves).point == 3);
  vote.clear();
  vote.offer(0.0, 5);
  vote.offer(4 * margin * margin, 3);
  CHECK(vote.decide(nobody_moves).point == 5);
}

TEST_CASE("the margin of a tie is one of distances", "[voxels]") {
  // Four points about the middle of a cell; the first is farther from their mean than the second by
  // half of its offset, 0.8e-9 m.
  const double off = 1.6e-9;
  LabelledCloud cloud;
  cloud.points = {{0.08 - off, 0.1, 0.1}, {0.12, 0.1, 0.1}, {0.1, 0.15, 0.1}, {0.1, 0.05, 0.1}};
  cloud.labels = {40, 252, 50, 50};
  const LabelledVoxels voxels = voxelise(cloud, 0.2, LabelClasses(LabelRule{}), 1);
  REQUIRE(voxels.size() == 1);
  CHECK(voxels.cloud.labels[0] == 40);
  CHECK(voxels.mixed_label_ties == 1);
}

TEST_CASE("mixed ties are counted over all cells", "[voxels]") {
  // As many cells as two threads' shares of work; only the first has a tie, of two points that lie
  // as far from their mean.
  LabelledCloud cloud;
  for (int x = 0; x < 2 * 16384; ++x) {
    cloud.points.emplace_back(x + 0.25, 0.5, 0.5);
    cloud.labels.push_back(40);
  }
  cloud.points.emplace_back(0.75, 0.5, 0.5);
  cloud.labels.push_back(252);
  const LabelledVoxels voxels = voxelise(cloud, 1.0, LabelClasses(LabelRule{}), 2);
  CHECK(voxels.size() == 2 * 16384);
  CHECK(voxels.mixed_label_ties == 1);
}

}  // namespace raymoval
