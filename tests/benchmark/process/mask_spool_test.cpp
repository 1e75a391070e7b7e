// SPDX-License-Identifier: MIT
#include "benchmark/process/mask_spool.h"

#include <catch2/catch.hpp>

#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

TEST_CASE("Masks come back from the spool in any order, and leave no file") {
  const test::TwoScans world;  // Three points, then one.
  const test::TemporaryFolder folder;
  const TimedSource scans(world);
  MaskSpool spool("mine", scans, folder.path() / "map.pcd");
  spool.accept(1, {1});
  spool.accept(0, {1, 0, 1});
  spool.check_complete();
  CHECK(spool.get(0) == Mask{1, 0, 1});
  CHECK(spool.get(1) == Mask{1});
  CHECK(spool.point_count() == 4);
  CHECK(spool.removed_count() == 3);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("Confidence comes back from its spool, and leaves no file") {
  const test::TwoScans world;  // Three points, then one.
  const test::TemporaryFolder folder;
  const TimedSource scans(world);
  const Calibration calibration{"", {{0.0F, 0.0F}, {1.0F, 1.0F}}};
  ConfidenceSpool spool("mine", calibration, scans, folder.path() / "map.pcd");
  spool.accept(1, std::vector<float>{1.0F});
  spool.accept(0, std::vector<float>{0.0F, 0.5F, 0.004F});
  spool.check_complete();
  CHECK(spool.get(0) == std::string({0, 125, 1}));
  CHECK(spool.get(1) == std::string({static_cast<char>(250)}));
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("The spool holds a method to one mask of the right size per scan") {
  const test::TwoScans world;
  const test::TemporaryFolder folder;
  const TimedSource scans(world);
  MaskSpool spool("mine", scans, folder.path() / "map.pcd");
  CHECK_THROWS_AS(spool.accept(2, {1}), MethodError);
  CHECK_THROWS_WITH(spool.accept(0, {1, 0}), Contains("scan 0") && Contains("2 values"));
  CHECK_THROWS_AS(spool.accept(0, {1, 0, 2}), MethodError);
  spool.accept(0, {1, 0, 1});
  CHECK_THROWS_WITH(spool.accept(0, {1, 0, 1}), Contains("second time"));
  CHECK_THROWS_WITH(spool.check_complete(), Contains("no mask for scan 1"));
}

TEST_CASE("A spool that cannot be made says where") {
  const test::TwoScans world;
  const TimedSource scans(world);
  CHECK_THROWS_WITH(MaskSpool("mine", scans, "/no/folder/map.pcd"),
                    Contains("/no/folder/map.pcd") && Contains("cannot be made"));
}
