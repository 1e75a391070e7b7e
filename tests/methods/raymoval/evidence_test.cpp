// SPDX-License-Identifier: MIT
// Which voxels a scan erases, on a map of a single voxel.
#include <catch2/catch.hpp>
#include <numbers>

#include "core/angle.h"
#include "methods/raymoval/erase_evidence.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

namespace {

/// A sensor in the middle of a voxel at the origin, columns of 1 degree and rows of 0.15 degrees
/// from -9 to 9. Columns 180 to 182 look along x, half a degree to 2.5 degrees to the left, and
/// row 60 looks 0.075 degrees up.
class Lookout {
 public:
  explicit Lookout(double voxel_size = 1.0) {
    parameters.voxel_size = voxel_size;
    parameters.azimuth_bins = 360;
    parameters.elevation_bins = 120;
    parameters.elevation_margin = 0;
    sensor.elevation_min = -9 * kDegree;
    sensor.elevation_max = 9 * kDegree;
    pose.translation().setConstant(voxel_size / 2);
  }

  struct Return {
    int column, row;
    double range;
  };

  /// The voxels that a scan erases from a map of `voxel` alone.
  std::vector<VoxelIndex> seen_through(const std::vector<Return>& returns,
                                       const VoxelIndex& voxel) {
    StaticMap map(parameters.voxel_size);
    map.integrate({voxel});
    ScanAgainstMap test(parameters, sensor);
    EvidenceFinder finder(parameters, sensor, test.grid());
    test.project_scan(scan_of(returns, test.grid()), {});
    test.cast_first_hits(map.occupied(), {});
    test.find_references(map, {});
    return finder.find(test, map.occupied(), {});
  }

  /// Whether the voxel 9.5 m ahead is erased by a return far behind it. Another return, at the
  /// front of the voxel, is `columns` and `rows` beside that return.
  bool is_erased_beside(int columns, int rows) {
    const VoxelIndex ahead(10, 0, 0);
    const auto seen = seen_through({{180, 60, 30.0}, {180 + columns, 60 + rows, 9.4}}, ahead);
    CHECK((seen.empty() || seen == std::vector<VoxelIndex>{ahead}));
    return !seen.empty();
  }

  /// Rows above the return behind within which one at the front saves the voxel.
  int reach_of_rows() {
    int rows = 0;
    while (!is_erased_beside(0, rows + 1)) ++rows;
    return rows;
  }

  Parameters parameters;
  SensorModel sensor;
  Pose pose = Pose::Identity();

 private:
  [[nodiscard]] Scan scan_of(const std::vector<Return>& returns, const AngularGrid& grid) const {
    Scan scan;
    scan.T_world_sensor = pose;
    for (const Return& at : returns) {
      const Eigen::Vector3d direction = grid.direction(at.row * grid.azimuth_bins + at.column);
      scan.points.emplace_back((at.range * direction).cast<float>());
    }
    return scan;
  }
};

}  // namespace

TEST_CASE("a return at the front saves a voxel as far as the next beam", "[raymoval]") {
  Lookout lookout;
  // Beams 0.35 degrees apart are 2.3 rows: the third one is reached.
  lookout.sensor.elevation_step = 0.35 * kDegree;
  CHECK(lookout.reach_of_rows() == 3);
  // Beams far apart, or of unknown distance: half a degree, 3.3 rows.
  lookout.sensor.elevation_step = 4.0 * kDegree;
  CHECK(lookout.reach_of_rows() == 4);
  lookout.sensor.elevation_step = 0.0;
  CHECK(lookout.reach_of_rows() == 4);
  // Beams nearer than rows: one row at least.
  lookout.sensor.elevation_step = 0.01 * kDegree;
  CHECK(lookout.reach_of_rows() == 1);
  // A given value takes precedence, also 0.
  lookout.parameters.erase_elevation_window = 2;
  CHECK(lookout.reach_of_rows() == 2);
  lookout.parameters.erase_elevation_window = 0;
  CHECK(lookout.reach_of_rows() == 0);
}

TEST_CASE("a return at the front saves a voxel at most a hundred rows beside it", "[raymoval]") {
  // Rows of 0.0025 degrees: half a degree would be 200 of them.
  Lookout lookout;
  lookout.parameters.elevation_bins = 3600;
  lookout.sensor.elevation_min = -4.5 * kDegree;
  lookout.sensor.elevation_max = 4.5 * kDegree;
  const auto erases_beside = [&](int rows) {
    return !lookout.seen_through({{180, 1800, 30.0}, {180, 1800 + rows, 9.4}}, {10, 0, 0}).empty();
  };
  CHECK_FALSE(erases_beside(100));
  CHECK(erases_beside(101));
}

TEST_CASE("a return at the front saves a voxel as many columns beside it as asked for",
          "[raymoval]") {
  Lookout lookout;
  for (const int window : {0, 1}) {
    lookout.parameters.erase_azimuth_window = window;
    CHECK(lookout.is_erased_beside(1, 0) == (window < 1));
    CHECK(lookout.is_erased_beside(2, 0));
  }
}

TEST_CASE("a voxel in which the scan has a point itself is not seen through", "[raymoval]") {
  Lookout lookout;
  // Its columns are 3.5 to 8.5 degrees to the left; beside the ray, no window reaches the other.
  const VoxelIndex aside(10, 1, 0);
  CHECK(lookout.seen_through({{184, 60, 30.0}}, aside).size() == 1);
  CHECK(lookout.seen_through({{184, 60, 30.0}, {187, 60, 9.885}}, aside).empty());
  // In the voxel behind it, which is of the same brick.
  CHECK(lookout.seen_through({{184, 60, 30.0}, {187, 60, 10.8}}, aside).size() == 1);
  // At the same place of another brick, in which the map has nothing.
  CHECK(lookout.seen_through({{180, 60, 26.0}}, {10, 0, 0}).size() == 1);
}

TEST_CASE("a falling ray has to cross a voxel's height behind the first hit", "[raymoval]") {
  // Row 21 looks 5.775 degrees down: a ray falls 0.5 m, a voxel, in 0.5 / 0.10062 = 4.97 m.
  Lookout lookout(0.5);
  lookout.parameters.erase_height_limit = 100.0;
  const AngularGrid grid = grid_for(lookout.sensor, lookout.parameters);
  const Eigen::Vector3d direction = grid.direction(21 * 360 + 180);
  REQUIRE(direction.z() == Approx(-0.10062).margin(1e-5));
  const VoxelIndex hit = voxel_index(lookout.pose * (10.2 * direction), 2.0);
  OccupancyMap map(0.5);
  map.insert(hit);
  const double first = cast_ray(map, {lookout.pose.translation(), direction}, {2.7, 60})->range;
  const auto erases = [&](double behind) {
    return !lookout.seen_through({{180, 21, first + behind}}, hit).empty();
  };
  CHECK_FALSE(erases(4.9));
  CHECK(erases(5.1));
  lookout.parameters.erase_height = 2.0;
  CHECK_FALSE(erases(9.8));
  CHECK(erases(10.1));
  lookout.parameters.erase_height_limit = 6.0;
  CHECK_FALSE(erases(5.9));
  CHECK(erases(6.1));
}

}  // namespace raymoval::raymoval_test
