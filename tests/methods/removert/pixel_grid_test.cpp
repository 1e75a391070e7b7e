// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <random>

#include "methods/removert/scan_image.h"
#include "tests/methods/removert/point_world.h"

namespace raymoval::removert_test {
using namespace raymoval::removert_method;

namespace {

PixelGrid grid_with(bool clamp, bool wrap, double resolution = 2.5) {
  Parameters parameters;
  parameters.clamp_fov = clamp;
  parameters.wrap_azimuth = wrap;
  return {parameters, resolution};
}

int pixel(const PixelGrid& grid, const Eigen::Vector3f& point) {
  return grid.pixel_of(point.cast<double>());
}

}  // namespace

TEST_CASE("removert: images have round(V alpha) rows and round(H alpha) columns") {
  const struct {
    double resolution;
    int rows, columns;
  } cases[] = {{2.5, 125, 900}, {2.2, 110, 792}, {2.0, 100, 720},
               {1.5, 75, 540},  {1.0, 50, 360},  {1.8182, 91, 655}};
  for (const auto& expected : cases) {
    const PixelGrid grid(Parameters{}, expected.resolution);
    CHECK(grid.rows() == expected.rows);
    CHECK(grid.columns() == expected.columns);
  }
}

TEST_CASE("removert: points outside the vertical field of view are in no pixel unless clamped") {
  CHECK(pixel(grid_with(false, true), polar(5, -25.1)) == kOutside);
  CHECK(pixel(grid_with(false, true), polar(5, 25.1)) == kOutside);
  CHECK(pixel(grid_with(true, true), polar(5, -40)) == 124 * 900 + 450);
  CHECK(pixel(grid_with(true, true), polar(5, 40)) == 450);
  // Down to the border itself they are: 125 rounds to row 125, of which there is none, so to 124.
  CHECK(pixel(grid_with(false, true), polar(5, -24.99)) == 124 * 900 + 450);
}

TEST_CASE("removert: the two half columns behind the sensor are one only if wrapped") {
  const Eigen::Vector3f left(-20, 0.035F, 0), right(-10, -0.0175F, 0);  // az +-179.9 degrees
  CHECK(pixel(grid_with(false, true), left) == 63 * 900);
  CHECK(pixel(grid_with(false, true), right) == 63 * 900);
  CHECK(pixel(grid_with(false, false), left) == 63 * 900 + 899);
  CHECK(pixel(grid_with(false, false), right) == 63 * 900);
}

TEST_CASE("removert: a narrow image leaves out or clamps what is beside it") {
  Parameters parameters;
  parameters.horizontal_fov = 90.0;  // 225 columns at 2.5 pixels per degree
  CHECK(pixel({parameters, 2.5}, polar(5, 0.1, 46)) == kOutside);
  CHECK(pixel({parameters, 2.5}, polar(5, 0.1, -46)) == kOutside);
  parameters.clamp_fov = true;
  CHECK(pixel({parameters, 2.5}, polar(5, 0.1, 46)) == 62 * 225 + 224);
  CHECK(pixel({parameters, 2.5}, polar(5, 0.1, -46)) == 62 * 225);
}

TEST_CASE("removert: single precision finds the pixel of double precision or says it cannot") {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0.0F, 1.0F);
  for (const double field : {50.0, 180.0}) {
    for (const bool clamp : {false, true}) {
      Parameters parameters;
      parameters.vertical_fov = field;
      parameters.clamp_fov = clamp;
      const PixelGrid grid(parameters, 2.5);
      int ambiguous = 0;
      PointBatch batch;
      for (int round = 0; round < 400; ++round) {
        const float scale = std::pow(10.0F, normal(random));
        for (int i = 0; i < PointBatch::kSize; ++i) {
          batch.x[i] = scale * normal(random);
          batch.y[i] = scale * normal(random);
          batch.z[i] = 0.5F * scale * normal(random);
        }
        batch.project(grid, PointBatch::kSize);
        for (int i = 0; i < PointBatch::kSize; ++i) {
          const Eigen::Vector3d point(batch.x[i], batch.y[i], batch.z[i]);
          const int fast = grid.fast_pixel(batch.row[i], batch.column[i]);
          ambiguous += fast == kAmbiguous ? 1 : 0;
          if (fast != kAmbiguous && fast != grid.pixel_of(point)) FAIL(point.transpose());
          if (std::abs(batch.range[i] - point.norm()) > 1e-6 * point.norm()) FAIL(batch.range[i]);
        }
      }
      // The margin is 1e-3 * 2.5 pixels each side of two borders: 1 % of the points; a few more lie
      // close to the sensor's axis.
      CHECK(ambiguous > 0);
      CHECK(ambiguous < 400 * PointBatch::kSize / 10);
    }
  }
}

}  // namespace raymoval::removert_test
