// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/voxel_runs.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/methods/raymoval/random_map.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using random_map::Random;

namespace {

/// Points that stay in a voxel of 0.2 m for a while.
Scan wandering_scan(std::size_t count, Random& random) {
  Scan scan;
  scan.T_world_sensor = random_map::pose({12.3, -45.6, 0.7}, random, 0.5);
  Eigen::Vector3f at(5, 0, 0);
  for (std::size_t k = 0; k < count; ++k) {
    for (int axis = 0; axis < 3; ++axis) at[axis] += static_cast<float>(random.real(-0.05, 0.05));
    scan.points.push_back(at);
  }
  return scan;
}

}  // namespace

TEST_CASE("a run is the longest stretch of points in one voxel", "[raymoval]") {
  Random random(31);
  VoxelRuns runs;
  for (const std::size_t count : {0, 1, 2, 1023, 1025, 8191, 8192, 8193, 20000}) {
    const Scan scan = wandering_scan(count, random);
    for (const int threads : {1, 3}) {
      INFO(count << " points, " << threads << " threads");
      find_voxels(scan, 5.0, threads, runs);
      REQUIRE(runs.first.size() == runs.size() + 1);
      CHECK(runs.first.front() == 0);
      CHECK(runs.first.back() == count);
      const std::vector<VoxelIndex> voxels = runs.of_points(runs.voxels);
      REQUIRE(voxels.size() == count);
      for (std::size_t k = 0; k < count; ++k) {
        REQUIRE(voxels[k] == voxel_index(scan.T_world_sensor * scan.points[k].cast<double>(), 5.0));
      }
      for (std::size_t run = 1; run < runs.size(); ++run) {
        REQUIRE(runs.first[run] > runs.first[run - 1]);
        // Each thread's part of the points begins a run.
        if (runs.first[run] % 8192 != 0) REQUIRE(runs.voxels[run] != runs.voxels[run - 1]);
      }
    }
  }
}

TEST_CASE("a run is within a mask if all of its points are", "[raymoval]") {
  VoxelRuns runs;
  runs.voxels = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  runs.first = {0, 2, 3, 5, 6};
  CHECK(runs_within(runs, {1, 1, 0, 1, 0, 1}) == Mask{1, 0, 0, 1});
  CHECK(runs_within(runs, {0, 1, 1, 0, 1, 0}) == Mask{0, 1, 0, 0});
}

TEST_CASE("the error of a point beyond the lattice names that point", "[raymoval]") {
  for (const std::size_t bad : {0, 7, 1500, 8999}) {
    Scan scan;
    scan.points.assign(9000, {1, 2, 3});
    scan.points[bad] = {-3333333.0F, 0, 0};
    VoxelRuns runs;
    try {
      find_voxels(scan, 5.0, 2, runs);
      FAIL("no error");
    } catch (const DataError& error) {
      INFO(error.what());
      CHECK(std::string(error.what()).find("-3333333") != std::string::npos);
    }
  }
}

}  // namespace raymoval::raymoval_test
