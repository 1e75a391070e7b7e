// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/votes.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/methods/mapcleaner/scenes.h"
#include "tests/methods/toy_world.h"

namespace raymoval::mapcleaner_test {
using namespace raymoval::mapcleaner_method;

namespace {

/// A point at a direction in degrees and a range in metres.
Eigen::Vector3f at(double azimuth, double elevation, double range) {
  return (range * toy::direction(azimuth * kDegree, elevation * kDegree)).cast<float>();
}

int pixel_of(const ImageFrame& frame, const Eigen::Vector3f& point) {
  ImageFrame::Batch batch;
  batch.x[0] = point.x();
  batch.y[0] = point.y();
  batch.z[0] = point.z();
  frame.project(batch, 1);
  return frame.pixel_of(batch, 0);
}

RangeImage image_of(const Parameters& parameters, const std::vector<Eigen::Vector3f>& points,
                    const SensorModel& sensor = {}) {
  RangeImage image(parameters, sensor);
  Scan scan;
  scan.points = points;
  image.fill(scan, 1);
  return image;
}

/// The observation of a place by an image.
Sight look(const RangeImage& image, const Eigen::Vector3f& place) {
  return image.look(pixel_of(image.frame(), place), place.norm());
}

}  // namespace

TEST_CASE("mapcleaner: images go all around, 15 degrees up and down") {
  const ImageFrame frame{Parameters{}, SensorModel{}};
  CHECK(frame.rows == 75);
  CHECK(frame.columns == 2250);
  CHECK(pixel_of(frame, at(-179.99, -14.99, 10)) == 0);
  CHECK(pixel_of(frame, at(179.99, -14.99, 10)) == 2249);
  CHECK(pixel_of(frame, at(-179.99, 14.99, 10)) == 74 * 2250);
  CHECK(pixel_of(frame, at(0.08, 0.0, 10)) == 37 * 2250 + 1125);
  CHECK(pixel_of(frame, at(0, -15.01, 10)) == -1);
  CHECK(pixel_of(frame, at(0, 15.01, 10)) == -1);
  CHECK(pixel_of(frame, {0, 0, 0}) == -1);
}

TEST_CASE("mapcleaner: what rounding puts behind the last column of a full turn is in it") {
  ImageFrame frame{Parameters{}, SensorModel{}};
  ImageFrame::Batch batch;
  batch.row[0] = 3.5F;
  batch.range[0] = 10.0F;
  batch.column[0] = static_cast<float>(frame.columns);
  CHECK(frame.pixel_of(batch, 0) == 3 * frame.columns + frame.columns - 1);
  frame.is_circle = false;
  CHECK(frame.pixel_of(batch, 0) == -1);
}

TEST_CASE("mapcleaner: images have the sensor's field of view if they are to") {
  Parameters parameters;
  parameters.public_field_of_view = false;
  SensorModel sensor;
  sensor.azimuth_min = 150 * kDegree;  // Through the back, 60 degrees wide.
  sensor.azimuth_max = 210 * kDegree;
  sensor.elevation_min = -24.8 * kDegree;
  sensor.elevation_max = 2.0 * kDegree;
  parameters.column_width = 0.5;
  const ImageFrame frame(parameters, sensor);
  // Columns of 0.5 and rows of 0.4 degrees, one more on either side.
  CHECK(frame.columns == 122);
  CHECK(frame.rows == 69);
  CHECK_FALSE(frame.is_circle);
  CHECK(pixel_of(frame, at(150.1, -24.7, 5)) == 122 + 1);
  CHECK(pixel_of(frame, at(-150.1, -24.7, 5)) == 122 + 120);
  CHECK(pixel_of(frame, at(149.0, -24.7, 5)) == -1);
  CHECK(pixel_of(frame, at(-149.0, -24.7, 5)) == -1);
  CHECK(pixel_of(frame, at(0, 0, 5)) == -1);
}

TEST_CASE("mapcleaner: where a window is a step high, beams are in the middle of rows") {
  Parameters parameters;
  parameters.public_field_of_view = parameters.public_steps = false;
  const SensorModel sensor = sensor_model_named("vlp16");
  const Parameters own = for_sensor(parameters, sensor);
  const ImageFrame frame(own, sensor);
  CHECK(frame.rows == 48);  // 45 from beam to beam, a half and a whole one on either side.
  for (int beam = 0; beam < 16; ++beam) {
    for (const double beside : {-0.3, 0.3}) {
      const int pixel = pixel_of(frame, at(10.0, -15.0 + 2.0 * beam + beside, 10.0));
      CHECK(pixel / frame.columns == 1 + 3 * beam);
    }
  }
}

TEST_CASE("mapcleaner: single angles are those of the library") {
  std::mt19937 random(5);
  const ImageFrame frame{Parameters{}, SensorModel{}};
  std::uniform_real_distribution<double> azimuth(-180, 180), elevation(-89, 89), range(0.5, 90);
  for (int i = 0; i < 2000; ++i) {
    const double a = azimuth(random), e = elevation(random), r = range(random);
    ImageFrame::Batch batch;
    const Eigen::Vector3f point = at(a, e, r);
    batch.x[0] = point.x();
    batch.y[0] = point.y();
    batch.z[0] = point.z();
    frame.project(batch, 1);
    CHECK(std::abs(static_cast<double>(batch.column[0]) - (a + 180) / 0.16) < 1e-3);
    CHECK(std::abs(static_cast<double>(batch.row[0]) - (e + 15) / 0.4) < 1e-3);
    CHECK(static_cast<double>(batch.range[0]) == Approx(r).epsilon(1e-6));
  }
}

TEST_CASE("mapcleaner: a place is seen, hidden, seen through, or nothing is told") {
  const Parameters parameters;
  const RangeImage image = image_of(parameters, {at(0.08, 0, 10)});
  CHECK(look(image, at(0.08, 0, 10.4)) == Sight::kSeen);
  CHECK(look(image, at(0.08, 0, 9.6)) == Sight::kSeen);
  CHECK(look(image, at(0.08, 0, 9.4)) == Sight::kSeenThrough);
  CHECK(look(image, at(0.08, 0, 10.6)) == Sight::kNothing);
  // Two columns and one row away, no farther.
  CHECK(look(image, at(0.08 + 0.32, 0.4, 9)) == Sight::kSeenThrough);
  CHECK(look(image, at(0.08 + 0.48, 0, 9)) == Sight::kNothing);
  CHECK(look(image, at(0.08, -0.8, 9)) == Sight::kNothing);
  SECTION("whatever else is in the window, what is equal decides, then what is nearer") {
    const RangeImage several = image_of(
        parameters, {at(-0.08, 0, 5), at(0.08, 0, 10), at(0.24, 0, 20), at(0.08, 0.4, 30)});
    CHECK(look(several, at(0.08, 0, 20.3)) == Sight::kSeen);
    CHECK(look(several, at(0.08, 0, 10.3)) == Sight::kSeen);
    CHECK(look(several, at(0.08, 0, 7)) == Sight::kNothing);
    CHECK(look(several, at(0.08, 0, 4)) == Sight::kSeenThrough);
    CHECK(look(several, at(0.08, 0, 15)) == Sight::kNothing);
    // -0.08 is out of the window of 0.40, so that 10 m are the nearest there.
    CHECK(look(several, at(0.40, 0, 7)) == Sight::kSeenThrough);
  }
  SECTION("the last column is beside the first") {
    const RangeImage behind = image_of(parameters, {at(179.9, 0, 10)});
    CHECK(look(behind, at(-179.9, 0, 9)) == Sight::kSeenThrough);
    CHECK(look(behind, at(-179.5, 0, 9)) == Sight::kNothing);
  }
}

TEST_CASE("mapcleaner: a pixel has its last point, or its nearest") {
  Parameters parameters;
  const std::vector<Eigen::Vector3f> points = {at(0.08, 0, 5), at(0.09, 0, 20), at(0.08, 0, 10)};
  CHECK(look(image_of(parameters, points), at(0.08, 0, 7)) == Sight::kSeenThrough);
  parameters.public_overwrite = false;
  CHECK(look(image_of(parameters, points), at(0.08, 0, 7)) == Sight::kNothing);
  CHECK(look(image_of(parameters, points), at(0.08, 0, 5)) == Sight::kSeen);
}

TEST_CASE("mapcleaner: voxels around the sensor are voted on, and chosen anew as it travels") {
  ThinnedPoints voxels(0.2);
  for (const double x : {10.05, 15.05, 30.05}) voxels.add({x, 0.01, 0.01});
  Parameters parameters;
  parameters.submap_radius = 12.0;
  parameters.submap_travel = 4.0;
  VoxelVotes votes(parameters, voxels, SensorModel{});
  const auto scan_from = [&](double x) {
    Scan scan;
    scan.T_world_sensor.translation().x() = x;
    scan.points.push_back(at(0.1, 0.1, 60.0));  // Behind all of them.
    votes.add(scan, {});
  };
  scan_from(0.0);
  CHECK(votes.balance(0) == 1);
  CHECK(votes.balance(1) == 0);
  votes.add(Scan{}, {});  // Says nothing and chooses nothing.
  scan_from(4.0);         // No farther than the travel: the same voxels.
  CHECK(votes.balance(0) == 2);
  CHECK(votes.balance(1) == 0);
  scan_from(4.5);
  CHECK(votes.balance(0) == 3);
  CHECK(votes.balance(1) == 1);
  CHECK(votes.balance(2) == 0);
  CHECK(votes.is_dynamic(1));
  CHECK_FALSE(votes.is_dynamic(2));
}

}  // namespace raymoval::mapcleaner_test
