// SPDX-License-Identifier: MIT
#include "methods/removert/visibility.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <optional>
#include <random>

#include "tests/methods/removert/point_world.h"

namespace raymoval::removert_test {
using namespace raymoval::removert_method;

namespace {

/// Cells so small that each point has its own.
const CellLattice kFine(0.01);

/// A map of these points, and the place of each of them in it.
struct NumberedMap {
  explicit NumberedMap(const Points& input) {
    MapBuilder builder(kFine);
    builder.add(input, Pose::Identity(), 1);
    points = builder.finish();
    REQUIRE(points.size() == input.size());
    VoxelMap<std::size_t> of_cell;
    for (const Block& block : points.blocks) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        of_cell[voxel_key(kFine.cell_index(block.key, points.id[i]))] = i;
        positions.push_back(points.position(block, i));
      }
    }
    for (const Eigen::Vector3f& point : input) {
      place.push_back(of_cell.at(voxel_key(kFine.place_of(point.cast<double>()).index)));
    }
  }
  MapPoints points;
  std::vector<Eigen::Vector3d> positions;  ///< In the order of `points`.
  std::vector<std::size_t> place;
};

/// Flags in the order of the map's points.
Mask flags(const NumberedMap& map, const Points& scan, const Parameters& parameters,
           Candidates candidates, const Pose& T_world_sensor = Pose::Identity(),
           double resolution = 2.5) {
  VisibilityPass pass(map.points, parameters, candidates);
  const ScanImage image(scan, PixelGrid(parameters, resolution), parameters, candidates);
  pass.show(image, T_world_sensor.inverse());
  return pass.flagged();
}

/// Flags in the order of `map`.
Mask dynamic(const Points& map, const Points& scan, const Parameters& parameters = {}) {
  const bool absolute = parameters.difference == DifferenceRule::kAbsolute;
  const NumberedMap numbered(map);
  const Mask found =
      flags(numbered, scan, parameters, absolute ? Candidates::kAll : Candidates::kInFront);
  Mask of_map;
  for (const std::size_t place : numbered.place) of_map.push_back(found[place]);
  return of_map;
}

}  // namespace

TEST_CASE("removert: a map point that a scan sees through is dynamic, what it sees is not") {
  // One pixel; 20 - 10 is more than 0.05 * 20 = 1.
  CHECK(dynamic({ahead(10), ahead(20)}, {ahead(20)}) == Mask{1, 0});
}

TEST_CASE("removert: a pixel flags its nearest map point only") {
  CHECK(dynamic({ahead(11), ahead(10), ahead(20)}, {ahead(20)}) == Mask{0, 1, 0});
}

TEST_CASE("removert: what stands behind a return is dynamic only in absolute difference") {
  Parameters parameters;
  CHECK(dynamic({ahead(20)}, {ahead(10)}, parameters) == Mask{0});
  parameters.difference = DifferenceRule::kAbsolute;
  CHECK(dynamic({ahead(20)}, {ahead(10)}, parameters) == Mask{1});
}

TEST_CASE("removert: the margin is a share of the scan's range") {
  // 20 - 19.01 = 0.99 is no more than 1, 20 - 18.9 = 1.1 is.
  CHECK(dynamic({ahead(19.01)}, {ahead(20)}) == Mask{0});
  CHECK(dynamic({ahead(18.9)}, {ahead(20)}) == Mask{1});
}

TEST_CASE("removert: ground below the field of view is not judged by the lowest ring") {
  // From 1.73 m up: G is at -40.9 degrees, 2.644 m; P at -24.77 degrees, 4.130 m, in the last row.
  const Eigen::Vector3f ground(2.0F, 0, -1.73F), ring(3.75F, 0, -1.73F);
  Parameters parameters;
  CHECK(dynamic({ground}, {ring}, parameters) == Mask{0});
  parameters.clamp_fov = true;  // 4.130 - 2.644 = 1.486 is more than 0.05 * 4.130 = 0.2065.
  CHECK(dynamic({ground}, {ring}, parameters) == Mask{1});
}

TEST_CASE("removert: behind the sensor the image has no seam") {
  const Points map{{-10, -0.0175F, 0.02F}}, scan{{-20, 0.035F, 0.04F}};
  Parameters parameters;
  CHECK(dynamic(map, scan, parameters) == Mask{1});
  parameters.wrap_azimuth = false;
  CHECK(dynamic(map, scan, parameters) == Mask{0});
}

TEST_CASE("removert: where the scan has no return nothing is decided") {
  for (const Candidates candidates : {Candidates::kInFront, Candidates::kAll}) {
    CHECK(flags(NumberedMap({ahead(15)}), {aside(15)}, {}, candidates) == Mask{0});
  }
}

TEST_CASE("removert: a difference of diff_upper or more is not believed, yet hides what follows") {
  Parameters parameters;
  parameters.diff_upper = 8.0;
  CHECK(dynamic({ahead(10)}, {ahead(20)}, parameters) == Mask{0});
  CHECK(dynamic({ahead(10), ahead(15)}, {ahead(20)}, parameters) == Mask{0, 0});
  CHECK(dynamic({ahead(15)}, {ahead(20)}, parameters) == Mask{1});
}

TEST_CASE("removert: a thin pole goes where a ray passes beside it in the same pixel") {
  // Pixels are 0.4 degrees wide, 0.035 m at 5 m: the pole's cell is 0.01 m beside the ray.
  CHECK(dynamic({{5, 0.01F, 0.01F}}, {{20, 0, 0.04F}}) == Mask{1});
  CHECK(dynamic({{5, 0.03F, 0.01F}}, {{20, 0, 0.04F}}) == Mask{0});
}

namespace {

/// Projects every point of the map, in double precision and without any shortcut.
Mask slow_flags(const std::vector<Eigen::Vector3d>& map, const Points& scan,
                const Parameters& parameters, const Pose& T_world_sensor, double resolution) {
  const PixelGrid grid(parameters, resolution);
  const auto pixels = static_cast<std::size_t>(grid.size());
  std::vector<float> in_scan(pixels, -1.0F);
  for (const Eigen::Vector3f& point : scan) {
    const int pixel = grid.pixel_of(point.cast<double>());
    if (pixel < 0) continue;
    float& nearest = in_scan[static_cast<std::size_t>(pixel)];
    const auto range = static_cast<float>(point.cast<double>().norm());
    nearest = nearest < 0.0F ? range : std::min(nearest, range);
  }
  std::vector<std::optional<std::size_t>> in_map(pixels);
  std::vector<double> ranges;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d local = T_world_sensor.inverse() * map[i];
    ranges.push_back(local.norm());
    const int pixel = grid.pixel_of(local);
    if (pixel < 0) continue;
    auto& nearest = in_map[static_cast<std::size_t>(pixel)];
    if (!nearest || ranges[i] < ranges[*nearest]) nearest = i;
  }
  Mask result(map.size(), 0);
  for (std::size_t u = 0; u < pixels; ++u) {
    if (in_scan[u] < 0.0F || !in_map[u]) continue;
    double difference = static_cast<double>(in_scan[u]) - ranges[*in_map[u]];
    if (parameters.difference == DifferenceRule::kAbsolute) difference = std::abs(difference);
    const double margin = parameters.gamma * static_cast<double>(in_scan[u]);
    if (difference > margin && difference < parameters.diff_upper) result[*in_map[u]] = 1;
  }
  return result;
}

/// Points mostly near the horizon, dense enough for several to share a pixel, one a cell.
Points random_cloud(std::mt19937& random, int count, double reach) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Points points;
  VoxelSet taken;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f point = polar(0.5 + reach * unit(random) * unit(random),
                                        -35.0 + 70.0 * unit(random), -180.0 + 360.0 * unit(random));
    const VoxelKey cell = voxel_key(kFine.place_of(point.cast<double>()).index);
    if (taken.insert(cell).second) points.push_back(point);
  }
  return points;
}

Pose random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Pose pose = Pose::Identity();
  const Eigen::Vector3d axis(unit(random), unit(random), unit(random));
  pose.linear() = Eigen::AngleAxisd(3.0 * unit(random), axis.normalized()).matrix();
  pose.translation() << 5.0 * unit(random), 5.0 * unit(random), 2.0 * unit(random);
  return pose;
}

}  // namespace

TEST_CASE("removert: shortcuts change no flag") {
  std::mt19937 random(11);
  int dynamic_points = 0;
  for (int round = 0; round < 64; ++round) {
    Parameters parameters;
    parameters.clamp_fov = (round & 1) != 0;
    parameters.wrap_azimuth = (round & 2) != 0;
    parameters.difference = (round & 4) != 0 ? DifferenceRule::kAbsolute : DifferenceRule::kSigned;
    if ((round & 8) != 0) parameters.horizontal_fov = 120.0;
    if ((round & 16) != 0) parameters.diff_upper = 10.0;
    const bool all = (round & 4) != 0 || (round & 32) != 0;
    const Candidates candidates = all ? Candidates::kAll : Candidates::kInFront;
    const NumberedMap map(random_cloud(random, 6000, 40.0));
    const Points scan = random_cloud(random, 2000, 60.0);
    const Pose pose = random_pose(random);
    // With few pixels the map is large enough for near points to hide far ones.
    const double resolution = round % 3 == 0 ? 0.2 : 1.0;
    const Mask fast = flags(map, scan, parameters, candidates, pose, resolution);
    INFO("round " << round);
    CHECK(fast == slow_flags(map.positions, scan, parameters, pose, resolution));
    dynamic_points += std::accumulate(fast.begin(), fast.end(), 0);
  }
  CHECK(dynamic_points > 5000);
}

}  // namespace raymoval::removert_test
