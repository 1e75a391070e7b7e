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

}  // namespace

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
