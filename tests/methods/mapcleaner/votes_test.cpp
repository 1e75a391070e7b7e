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

}  // namespace raymoval::mapcleaner_test
