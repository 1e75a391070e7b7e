// SPDX-License-Identifier: MIT
// Scenes along one row of voxels of 1 m, small enough to work out by hand.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/methods/peopleremover/listed_scans.h"

namespace raymoval::peopleremover_test {
using namespace raymoval::peopleremover_method;

namespace {

using Verdicts = std::vector<Mask>;

/// Whole beams, voxels of 1 m, clusters of any size, unless `changes` say more.
Verdicts verdicts(const ScanSource& scans, const Configuration& changes = {}) {
  auto method = peopleremover("none", {{"voxel_size", 1.0}, {"min_cluster_size", std::int64_t{1}}});
  for (const auto& [name, value] : changes) set_parameter(method.configuration, name, value);
  const MaskStore masks = masks_of(*method.make(), scans);
  Verdicts result;
  for (std::size_t i = 0; i < scans.size(); ++i) result.push_back(masks.get(i));
  return result;
}

Configuration set(const std::string& name, ParameterValue value) {
  return {{name, std::move(value)}};
}

/// At x = 8.5, with the normal (-1, 0, 0).
std::vector<Eigen::Vector3d> points_of_wall() {
  std::vector<Eigen::Vector3d> wall;
  for (int y = -4; y <= 4; ++y) {
    for (int z = -4; z <= 4; ++z) wall.emplace_back(8.5, 0.5 + 0.2 * y, 0.5 + 0.2 * z);
  }
  return wall;
}

}  // namespace

TEST_CASE("peopleremover: a voxel that one beam passes through is freed", "[peopleremover]") {
  ListedScans scans;
  scans.row({3.5}).row({8.5});
  CHECK(verdicts(scans) == Verdicts{{1}, {0}});
  // One freed voxel is a cluster of one.
  CHECK(verdicts(scans, set("min_cluster_size", std::int64_t{2})) == Verdicts{{0}, {0}});
}

TEST_CASE("peopleremover: a scan's own first point stops its beams", "[peopleremover]") {
  CHECK(verdicts(ListedScans().row({3.5, 8.5})) == Verdicts{{0, 0}});
}

TEST_CASE("peopleremover: an object that came nearer hides its old place from its own beams",
          "[peopleremover]") {
  // Scan 1's far beam stops at its own voxel 2; scan 0's beam passes it.
  CHECK(verdicts(ListedScans().row({3.5}).row({2.5, 8.5})) == Verdicts{{0}, {1, 0}});
}

TEST_CASE("peopleremover: one look through beats any number of observations", "[peopleremover]") {
  CHECK(verdicts(ListedScans().row({3.5}).row({3.5}).row({8.5})) == Verdicts{{1}, {1}, {0}});
}

TEST_CASE("peopleremover: small clusters are discarded before they spread", "[peopleremover]") {
  // Voxel 3 is freed but a cluster of one: with a minimum of two it must not reach voxel 5 either.
  const ListedScans scans = ListedScans().row({3.5, 5.5}).row({5.5});
  CHECK(verdicts(scans, set("min_cluster_size", std::int64_t{2})) == Verdicts{{0, 0}, {0}});
}

TEST_CASE("peopleremover: points within a voxel diagonal are static and take no part",
          "[peopleremover]") {
  // 1.7 m is below sqrt(3) m, 1.8 m is above. Scan 1 passes through both.
  CHECK(verdicts(ListedScans().row({2.2}).row({8.5})) == Verdicts{{0}, {0}});
  CHECK(verdicts(ListedScans().row({2.3}).row({8.5})) == Verdicts{{1}, {0}});
}

TEST_CASE("peopleremover: point shadows keep what stands right before a wall", "[peopleremover]") {
  // Wall at x = 8.5, normal (-1, 0, 0). Its axis beam ends sqrt(3) m in front: at x = 6.77, in
  // voxel 6. A point in voxel 7 is kept, a point in voxel 5 is removed.
  const std::vector<Eigen::Vector3d> wall = points_of_wall();
  for (const double x : {7.5, 5.5}) {
    ListedScans scans;
    scans.row({x}).scan(pose_at(0.5, 0.5, 0.5), wall);
    INFO("phantom at " << x);
    CHECK(verdicts(scans)[0] == Mask{1});
    CHECK(verdicts(scans, set("maxrange_method", std::string("normals")))[0] ==
          Mask{x < 6.0 ? std::uint8_t{1} : std::uint8_t{0}});
    CHECK(verdicts(scans, set("maxrange_method", std::string("normals")))[1] ==
          Mask(wall.size(), 0));
  }
}

TEST_CASE("peopleremover: a point beyond the lattice is refused", "[peopleremover]") {
  // 1.1 million voxels of 1 m away.
  CHECK_THROWS_AS(verdicts(ListedScans().row({1.1e6})), DataError);
}

}  // namespace raymoval::peopleremover_test
