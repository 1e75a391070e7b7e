// SPDX-License-Identifier: MIT
#include "methods/octomap/occupancy_tree.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "tests/methods/octomap/hand_scans.h"

namespace raymoval::octomap_test {
using namespace raymoval::octomap_method;

namespace {

/// A room with a moving box in it, seen from a moving place, without anything exact about it.
Points random_scan(std::mt19937& random, const Eigen::Vector3d& origin, double mover) {
  std::normal_distribution<double> direction;
  Points points;
  for (int i = 0; i < 900; ++i) {
    const Eigen::Vector3d u =
        Eigen::Vector3d(direction(random), direction(random), 0.3 * direction(random)).normalized();
    const std::vector<Box> solids{{{mover, 1.03, -3}, {mover + 1.1, 1.9, 3}}};
    double distance = enter_distance(solids[0], origin, u);
    for (int k = 0; k < 3; ++k) {
      const double wall = k == 2 ? 1.57 : 4.93;
      if (u[k] != 0.0)
        distance = std::min(distance, (std::copysign(wall, u[k]) - origin[k]) / u[k]);
    }
    points.push_back(origin + distance * u);
  }
  return points;
}

void insert_by_library(octomap::OcTree& tree, const Points& points, const Eigen::Vector3d& origin,
                       const Parameters& parameters) {
  octomap::Pointcloud cloud;
  for (const octomap::point3d& p : rounded(points)) cloud.push_back(p);
  tree.insertPointCloud(cloud, rounded(origin), parameters.maximum_range, false,
                        parameters.discretise);
}

/// Inserts scans both ways and compares the trees after each.
void compare_with_library(const Parameters& parameters, int threads, int scans = 14) {
  octomap::OcTree plain(parameters.resolution);
  HandMap map(parameters, threads);
  std::mt19937 random(11);
  for (int scan = 0; scan < scans; ++scan) {
    const Eigen::Vector3d origin(0.013 + 0.2 * (scan % 4), -0.51, 0.017);
    const Points points = random_scan(random, origin, -2.0 + 0.21 * scan);
    insert_by_library(plain, points, origin, parameters);
    map.insert(points, origin);
    INFO("scan " << scan);
    REQUIRE(plain.size() == map.tree().size());
    REQUIRE(map.tree().size() == map.tree().calcNumNodes());
    // Depth, children and log-odds of each node, inner ones too.
    REQUIRE(tree_bytes(plain) == tree_bytes(map.tree()));
  }
}

}  // namespace

TEST_CASE("the tree is node for node that of insertPointCloud", "[slow]") {
  Parameters parameters;
  SECTION("0.2 m") {}
  SECTION("0.05 m") {
    parameters.resolution = 0.05;
  }
  SECTION("one beam per occupied cell") {
    parameters.discretise = true;
  }
  SECTION("beams cut") {
    parameters.maximum_range = 3.1;
  }
  SECTION("beams cut, one per cell") {
    parameters.maximum_range = 3.1;
    parameters.discretise = true;
  }
  compare_with_library(parameters, 1);
  compare_with_library(parameters, 3, 4);
}

TEST_CASE("a map kept to some cells has the same values there, and nothing else") {
  const Parameters parameters;
  HandMap whole(parameters);
  const RunContext context;
  ScanCells cells(parameters, context);
  OccupancyTree kept(parameters);
  const CellLattice lattice(parameters.resolution);
  CellBlocks wanted;
  std::mt19937 random(11);
  std::set<CellCode> codes;
  for (double x = -4.9; x < 4.9; x += 0.6) codes.insert(*lattice.cell_of(rounded({x, 0.3, 0.1})));
  for (const CellCode code : codes) wanted.occupy(code);
  const Eigen::Vector3d origin(0.013, -0.51, 0.017);
  for (int scan = 0; scan < 8; ++scan) {
    const Points points = random_scan(random, origin, -2.0 + 0.21 * scan);
    whole.insert(points, origin);
    cells.compute(rounded(points), std::vector<PointRole>(points.size(), PointRole::kSurface),
                  rounded(origin));
    kept.update(cells.parts(), &wanted);
  }
  TreeReader of_whole(whole.tree()), of_kept(kept.tree());
  int known = 0;
  for (double x = -4.9; x < 4.9; x += 0.2) {
    const CellCode code = *lattice.cell_of(rounded({x, 0.3, 0.1}));
    const octomap::OcTreeNode* node = of_kept.find(code);
    known += node != nullptr ? 1 : 0;
    if (!codes.contains(code)) {
      CHECK(node == nullptr);
    } else if (const octomap::OcTreeNode* full = of_whole.find(code)) {
      REQUIRE(node != nullptr);
      CHECK(node->getLogOdds() == full->getLogOdds());
    }
  }
  CHECK(known > 8);
}

TEST_CASE("equal leaves are merged, and parted when they differ") {
  // Beams to a wall free a wedge of space; once all its cells are clamped, many merge.
  Parameters parameters;
  parameters.resolution = 0.4;
  HandMap map(parameters);
  Points wall;
  for (double y = 0.05; y < 6.4; y += 0.1) {
    for (double z = 0.05; z < 6.4; z += 0.1) wall.emplace_back(6.6, y, z);
  }
  const Eigen::Vector3d origin(-20.0, 3.1, 3.1);
  for (int i = 0; i < 7; ++i) map.insert(wall, origin);
  octomap::OcTree parted(map.tree());
  parted.expand();
  const std::size_t leaves = map.tree().getNumLeafNodes();
  CHECK(leaves < parted.getNumLeafNodes() / 2);
  const Eigen::Vector3d inside(5.0, 3.3, 3.3), beside(5.4, 3.3, 3.3);
  CHECK(map.log_odds(inside) == Approx(-2.000028));
  map.insert({inside}, {4.9, 3.3, 3.7});
  CHECK(map.log_odds(inside) == Approx(-2.000028 + 0.847298));
  CHECK(map.log_odds(beside) == Approx(-2.000028));
  CHECK(map.tree().getNumLeafNodes() > leaves);
}

TEST_CASE("a block whose cells stand at a clamp is parted only by what can change them") {
  // 8 x 8 x 8 cells in one node, all missed (or hit) until they stand at the clamp. What pushes one
  // of them further against it parts nothing; what pulls it back does. Nothing is merged again
  // where the tree is lazy, so that its size tells.
  Parameters parameters;
  parameters.lazy_eval = true;
  const CellLattice lattice(parameters.resolution);
  const CellCode cell = *lattice.cell_of(octomap::point3d(3.1F, 0.3F, 0.1F));
  for (const bool hits : {false, true}) {
    INFO((hits ? "hits" : "misses"));
    std::vector<CellBlocks> whole(1), one_hit(1), one_miss(1);
    CellBlock& block = whole[0].block(cell >> kBlockBits);
    (hits ? block.occupied : block.free).fill(~std::uint64_t{0});
    one_hit[0].occupy(cell);
    one_miss[0].block(cell >> kBlockBits).free[cell >> 6 & 7] |= std::uint64_t{1} << (cell & 63);
    OccupancyTree tree(parameters);
    std::vector<CellBlocks> elsewhere(1);  // The first cell of all is made down to its leaf.
    elsewhere[0].occupy(*lattice.cell_of(octomap::point3d(-3.1F, 0.3F, 0.1F)));
    tree.update(elsewhere);
    for (int scan = 0; scan < 6; ++scan) tree.update(whole);
    const double clamp = hits ? 3.5110 : -2.0000;
    CHECK(TreeReader(tree.tree()).find(cell)->getLogOdds() == Approx(clamp).margin(1e-3));
    const std::size_t size = tree.tree().size();
    tree.update(hits ? one_hit : one_miss);
    CHECK(tree.tree().size() == size);
    tree.update(hits ? one_miss : one_hit);
    CHECK(tree.tree().size() == size + 3 * 8);  // Eight nodes on each of three levels.
    const double pulled = clamp + (hits ? -0.4055 : 0.8473);
    CHECK(TreeReader(tree.tree()).find(cell)->getLogOdds() == Approx(pulled).margin(1e-3));
  }
}

TEST_CASE("lazy evaluation changes no leaf") {
  Parameters eager, lazy;
  lazy.lazy_eval = true;
  HandMap a(eager), b(lazy);
  std::mt19937 random(5);
  for (int scan = 0; scan < 8; ++scan) {
    const Eigen::Vector3d origin(0.013, -0.51, 0.017);
    const Points points = random_scan(random, origin, -2.0 + 0.21 * scan);
    a.insert(points, origin);
    b.insert(points, origin);
  }
  CHECK(b.tree().size() >= a.tree().size());
  for (double x = -4.9; x < 5.0; x += 0.2) {
    for (double y = -4.9; y < 5.0; y += 0.2) {
      REQUIRE(a.log_odds({x, y, 0.1}) == b.log_odds({x, y, 0.1}));
    }
  }
}

TEST_CASE("the reader gives the node that a search gives") {
  Parameters parameters;
  HandMap map(parameters);
  const CellLattice lattice(parameters.resolution);
  TreeReader of_nothing(map.tree());
  CHECK(of_nothing.find(*lattice.cell_of({1, 1, 1})) == nullptr);
  std::mt19937 random(5);
  const Eigen::Vector3d origin(0.013, -0.51, 0.017);
  for (int scan = 0; scan < 9; ++scan) map.insert(random_scan(random, origin, 0.3), origin);
  TreeReader reader(map.tree());
  std::uniform_real_distribution<float> anywhere(-7.0F, 7.0F);
  int known = 0;
  for (int i = 0; i < 20000; ++i) {
    // Every second query is near the last one: mostly in the same block.
    static octomap::point3d at;
    at = i % 2 == 0 ? octomap::point3d(anywhere(random), anywhere(random), anywhere(random) / 4)
                    : at + octomap::point3d(0.21F, 0.0F, 0.0F);
    const octomap::OcTreeNode* node = map.tree().search(at);
    known += node != nullptr ? 1 : 0;
    REQUIRE(reader.find(*lattice.cell_of(at)) == node);
  }
  CHECK(known > 2000);
  CHECK(known < 18000);
}

TEST_CASE("a wish to stop is heard within a scan") {
  const std::atomic<bool> cancel = true;
  RunContext context;
  context.cancel = &cancel;
  const Parameters parameters;
  ScanCells cells(parameters, context);
  const std::vector<octomap::point3d> points = {{3.0F, 0.0F, 0.0F}};
  CHECK_THROWS_AS(cells.compute(points, {PointRole::kSurface}, {0.0F, 0.0F, 0.0F}), Cancelled);
}

}  // namespace raymoval::octomap_test
