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

TEST_CASE("peopleremover: every scan is on the map before any beam is followed",
          "[peopleremover]") {
  CHECK(verdicts(ListedScans().row({8.5}).row({3.5})) == Verdicts{{0}, {1}});
}

TEST_CASE("peopleremover: points of scans within diff of the beam's own protect a voxel",
          "[peopleremover]") {
  ListedScans scans;
  scans.row({3.5}).row({8.5});
  const Configuration one = set("diff", std::int64_t{1});
  // The window of scan 1 is 0 to 2 and holds scan 0.
  CHECK(verdicts(scans, one) == Verdicts{{0}, {0}});
  // That of scan 2 is 1 to 3.
  scans.row({8.5});
  CHECK(verdicts(scans, one) == Verdicts{{1}, {0}, {0}});
  CHECK(verdicts(scans, set("diff", std::int64_t{2})) == Verdicts{{0}, {0}, {0}});
  CHECK(verdicts(scans, set("diff", std::int64_t{1000})) == Verdicts{{0}, {0}, {0}});
}

TEST_CASE("peopleremover: with diff, a voxel of the window also stops the beam",
          "[peopleremover]") {
  // Without: scan 1 passes voxel 3 and frees 3 and 5. With diff = 1 scan 0's voxel 3 stops it, and
  // only scan 2, whose window is 1 to 3, gets through to voxel 3; its beam ends in voxel 4.
  const ListedScans scans = ListedScans().row({3.5}).row({8.5}).row({4.5}).row({4.5}).row({6.5});
  CHECK(verdicts(scans) == Verdicts{{1}, {0}, {1}, {1}, {1}});
  // Scan 1: stopped in 3 (scan 0). Scans 2 and 3 free voxel 3. Scan 4 frees 3, is stopped in 4
  // (scan 3 in its window). Voxel 6: no beam gets there.
  CHECK(verdicts(scans, {{"diff", std::int64_t{1}}, {"subvoxel_accuracy", false}}) ==
        Verdicts{{1}, {0}, {0}, {0}, {0}});
}

TEST_CASE("peopleremover: an object that came nearer hides its old place from its own beams",
          "[peopleremover]") {
  // Scan 1's far beam stops at its own voxel 2; scan 0's beam passes it.
  CHECK(verdicts(ListedScans().row({3.5}).row({2.5, 8.5})) == Verdicts{{0}, {1, 0}});
}

TEST_CASE("peopleremover: one look through beats any number of observations", "[peopleremover]") {
  CHECK(verdicts(ListedScans().row({3.5}).row({3.5}).row({8.5})) == Verdicts{{1}, {1}, {0}});
}

TEST_CASE("peopleremover: near a freed voxel only the scans with points in it lose theirs",
          "[peopleremover]") {
  // Voxel 3 is freed by scan 1. Voxel 5, two away, keeps scan 1's point and loses scan 0's.
  const ListedScans scans = ListedScans().row({3.5, 5.5}).row({5.5});
  CHECK(verdicts(scans) == Verdicts{{1, 1}, {0}});
  CHECK(verdicts(scans, set("subvoxel_accuracy", false)) == Verdicts{{1, 0}, {0}});
  CHECK(verdicts(scans, set("half_voxel_radius", std::int64_t{1})) == Verdicts{{1, 0}, {0}});
  // Three away is too far.
  CHECK(verdicts(ListedScans().row({3.5, 6.5}).row({6.5})) == Verdicts{{1, 0}, {0}});
}

TEST_CASE(
    "peopleremover: a scan that never looked through also loses points near the freed voxel") {
  // Scan 1 frees voxel 3 and stops in voxel 4. Scan 2 stops in voxel 3 and also has a point in
  // voxel 4: this point is removed, scan 1's is kept.
  CHECK(verdicts(ListedScans().row({3.5}).row({4.5}).row({3.5, 4.5})) ==
        Verdicts{{1}, {0}, {1, 1}});
}

TEST_CASE("peopleremover: small clusters are discarded before they spread", "[peopleremover]") {
  // Voxel 3 is freed but a cluster of one: with a minimum of two it must not reach voxel 5 either.
  const ListedScans scans = ListedScans().row({3.5, 5.5}).row({5.5});
  CHECK(verdicts(scans, set("min_cluster_size", std::int64_t{2})) == Verdicts{{0, 0}, {0}});
}

TEST_CASE("peopleremover: clusters are those of all scans together", "[peopleremover]") {
  // Voxels 2 to 6, each of another scan, make one cluster of five.
  const ListedScans scans =
      ListedScans().row({2.6}).row({3.5}).row({4.5}).row({5.5}).row({6.5}).row({8.5});
  CHECK(verdicts(scans, set("min_cluster_size", std::int64_t{5})) ==
        Verdicts{{1}, {1}, {1}, {1}, {1}, {0}});
  CHECK(verdicts(scans, set("min_cluster_size", std::int64_t{6})) ==
        Verdicts{{0}, {0}, {0}, {0}, {0}, {0}});
}

TEST_CASE("peopleremover: the sensor's own voxel stops nothing and can be freed",
          "[peopleremover]") {
  // Scan 0 is 3 m back and has a point in the voxel of scan 1's sensor, (0, 0, 0). Scan 1's own
  // point nearer than the minimum range is ignored.
  ListedScans scans;
  scans.scan(pose_at(0.5, 0.5, -2.5), {{0.5, 0.5, 0.5}});
  scans.scan(pose_at(0.4, 0.5, 0.5), {{0.9, 0.5, 0.5}, {5.5, 0.5, 0.5}});
  CHECK(verdicts(scans) == Verdicts{{1}, {0, 0}});
  // As an own point of the sensor's voxel (minimum range 0.1 m) it protects that voxel, but lets
  // the beam through to voxel 3, where scan 2 has a point, seen from below.
  scans.scan(pose_at(3.5, 0.5, -2.5), {{3.5, 0.5, 0.5}});
  CHECK(verdicts(scans, set("minimum_range", 0.1)) == Verdicts{{0}, {0, 0}, {1}});
}

TEST_CASE("peopleremover: points within a voxel diagonal are static and take no part",
          "[peopleremover]") {
  // 1.7 m is below sqrt(3) m, 1.8 m is above. Scan 1 passes through both.
  CHECK(verdicts(ListedScans().row({2.2}).row({8.5})) == Verdicts{{0}, {0}});
  CHECK(verdicts(ListedScans().row({2.3}).row({8.5})) == Verdicts{{1}, {0}});
}

TEST_CASE("peopleremover: cells go down to minus infinity, not towards zero", "[peopleremover]") {
  // Mirrored at x = 0: sensor at -0.5, points at -3.5 and -8.5; and a point at 0.5 behind, which
  // would share a truncated voxel with -0.5.
  ListedScans scans;
  const Pose pose = pose_at(-0.5, -0.5, -0.5);
  scans.scan(pose, {{-3.5, -0.5, -0.5}}).scan(pose, {{-8.5, -0.5, -0.5}});
  scans.scan(pose_at(4.5, -0.5, -0.5), {{0.5, -0.5, -0.5}});
  CHECK(verdicts(scans) == Verdicts{{1}, {0}, {0}});
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

TEST_CASE("peopleremover: the voxel in which a shortened beam ends can be freed",
          "[peopleremover]") {
  // As above, the beam ends at x = 6.77: voxel 6 is its last.
  ListedScans scans;
  scans.row({6.5}).scan(pose_at(0.5, 0.5, 0.5), points_of_wall());
  CHECK(verdicts(scans, set("maxrange_method", std::string("normals")))[0] == Mask{1});
}

TEST_CASE("peopleremover: a point beyond the lattice is refused", "[peopleremover]") {
  // 1.1 million voxels of 1 m away.
  CHECK_THROWS_AS(verdicts(ListedScans().row({1.1e6})), DataError);
}

}  // namespace raymoval::peopleremover_test
