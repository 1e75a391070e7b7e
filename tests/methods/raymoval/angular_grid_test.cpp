// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/angular_grid.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "core/angle.h"
#include "core/simd/instruction_set_scope.h"
#include "methods/raymoval/kernels/voxel_runs.h"
#include "methods/raymoval/scan_against_map.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using std::numbers::pi;

namespace {

/// Four columns of 90 degrees, two rows of 45 degrees.
AngularGrid coarse_grid() {
  return {4, 2, -pi / 4, pi / 4};
}

}  // namespace

TEST_CASE("eq. 1: range, azimuth and elevation of a point") {
  const Spherical ahead = to_spherical({3.0, 0.0, 4.0});
  CHECK(ahead.range == Approx(5.0));
  CHECK(ahead.azimuth == Approx(0.0));
  CHECK(ahead.elevation == Approx(std::asin(0.8)));
  // Straight behind is +pi, the closed end of (-pi, pi].
  CHECK(to_spherical({-2.0, 0.0, 0.0}).azimuth == Approx(pi));
  CHECK(to_spherical({0.0, 0.0, -1.0}).elevation == Approx(-pi / 2));
  const Spherical origin = to_spherical({0.0, 0.0, 0.0});
  CHECK(origin.range == 0.0);
  CHECK(origin.azimuth == 0.0);
  CHECK(origin.elevation == 0.0);
}

TEST_CASE("eqs 2-3: steps and bins") {
  const AngularGrid grid = coarse_grid();
  CHECK(grid.azimuth_step() == Approx(pi / 2));
  CHECK(grid.elevation_step() == Approx(pi / 4));
  // Azimuth 0.1 is 3.24 from -pi, two steps of 1.57 and a bit: column 2. Elevation 0.1: row 1.
  CHECK(grid.bin_of(0.1, 0.1) == 1 * 4 + 2);
  CHECK(grid.bin_of(-0.1, -0.1) == 0 * 4 + 1);
  // pi and -pi are one direction.
  CHECK(grid.bin_of(pi, -0.1) == 0);
  CHECK(grid.bin_of(-pi, -0.1) == 0);
}

TEST_CASE("eqs 4-5: the centre of a bin lies in that bin") {
  const AngularGrid grid{36, 9, -0.4, 0.1};
  CHECK(grid.azimuth_centre(0) == Approx(-pi + pi / 36));
  CHECK(grid.elevation_centre(0) == Approx(-0.4 + 0.25 / 9));
  for (int bin = 0; bin < grid.size(); ++bin) {
    const Eigen::Vector3d direction = grid.direction(bin);
    CHECK(direction.norm() == Approx(1.0));
    const Spherical at = to_spherical(direction);
    CHECK(grid.bin_of(at.azimuth, at.elevation) == bin);
  }
}

TEST_CASE("eq. 10: a bin keeps its nearest range, the ego vehicle is in no bin") {
  const AngularGrid grid = coarse_grid();
  Scan scan;
  scan.points = {{-3, -1, -0.5F}, {5, 1, 0.5F}, {3, 1, 0.5F},
                 {1, 0.1F, 0.1F}, {0, 0, 9},    {-5, -1, -0.5F}};
  ProjectedScan projected;
  project(scan, grid, 2.0, 1, projected);
  CHECK(projected.bin == std::vector<std::int32_t>{0, 6, 6, -1, -1, 0});
  // The first point of the scan is the nearest in its bin, the third one in the other.
  CHECK(projected.minimum_range[0] == Approx(std::sqrt(9 + 1 + 0.25)));
  CHECK(projected.minimum_range[6] == Approx(std::sqrt(9 + 1 + 0.25)));
  CHECK(projected.range[1] == Approx(std::sqrt(25 + 1 + 0.25)));
  CHECK(projected.minimum_range[5] == kNoRange);
}

TEST_CASE("points on borders of bins and elsewhere go where the formulas say, on any processor",
          "[simd]") {
  // Every point of a lattice with the axes, the diagonals and the origin on it, and loose ones.
  Scan scan;
  scan.T_world_sensor.translation() = Eigen::Vector3d(1234.5, -77.25, 3.125);
  scan.T_world_sensor.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) scan.points.emplace_back(x, y, z);
    }
  }
  for (int k = 0; k < 3000; ++k) {
    const auto t = static_cast<float>(k);
    scan.points.emplace_back(40 * std::sin(t), 40 * std::cos(1.7F * t), 6 * std::sin(0.3F * t));
  }
  const AngularGrid grid{360, 90, -pi / 4, pi / 4};
  for (const InstructionSet set : supported_instruction_sets()) {
    INFO(instruction_set_name(set));
    const InstructionSetScope scope(set);
    ProjectedScan projected;
    project(scan, grid, 2.0, 2, projected);
    VoxelRuns runs;
    find_voxels(scan, 5.0, 2, runs);
    const std::vector<VoxelIndex> voxels = runs.of_points(runs.voxels);
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const Spherical at = to_spherical(scan.points[k].cast<double>());
      const auto bin = grid.bin_of(at.azimuth, at.elevation);
      REQUIRE(projected.bin[k] == (at.range < 2.0 ? -1 : bin.value_or(-1)));
      REQUIRE(projected.range[k] == static_cast<float>(at.range));
      REQUIRE(voxels[k] == voxel_index(scan.T_world_sensor * scan.points[k].cast<double>(), 5.0));
    }
  }
}

TEST_CASE("grids of the sensor's steps have as many bins as the steps need", "[raymoval]") {
  Parameters parameters;
  parameters.azimuth_bins = parameters.elevation_bins = 0;
  parameters.elevation_margin = 0;
  SensorModel sensor;
  sensor.elevation_min = -0.3;
  sensor.elevation_max = 0.1;
  const auto grid = [&](double azimuth_bins, double elevation_bins) {
    sensor.azimuth_step = kTurn / azimuth_bins;
    sensor.elevation_step = 0.4 / elevation_bins;
    const AngularGrid made = grid_for(sensor, parameters);
    return std::pair(made.azimuth_bins, made.elevation_bins);
  };
  CHECK(grid(1000.5, 64.5) == std::pair(1001, 65));
  CHECK(grid(35.5, 36.5) == std::pair(36, 37));
  CHECK(grid(10, 10) == std::pair(36, 36));
  CHECK(grid(1e6, 1e6) == std::pair(7200, 720));
  sensor.azimuth_step = sensor.elevation_step = 0.0;  // Unknown.
  CHECK(grid_for(sensor, parameters).azimuth_bins == 720);
  CHECK(grid_for(sensor, parameters).elevation_bins == 450);
}

}  // namespace raymoval::raymoval_test
