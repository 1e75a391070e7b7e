// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "core/angle.h"
#include "core/scan/local_frame.h"
#include "core/scan/sensor_model.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Beams that turn about +z. All angles in degrees.
struct Head {
  std::vector<double> elevations;
  double step = 0.2, first = -180.0, width = 360.0;
  double phase = 0.0;                  ///< Of the first column, as a part of the step.
  std::vector<double> shifts = {0.0};  ///< Of the columns of each beam in turn, in steps.
  double missing = 0.02, noise = 0.005;
};

std::vector<double> evenly(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

/// Range of a ray from 1.7 m above the ground between four walls, 5 m high and 16 x 30 m apart; 0
/// where it passes above them.
double range_in_yard(const Eigen::Vector3d& direction) {
  double range = 1e9;
  if (direction.z() < 0.0) range = -1.7 / direction.z();
  for (const auto& [axis, distance] : {std::pair{0, 15.0}, std::pair{1, 8.0}}) {
    range = std::min(range, distance / std::max(1e-9, std::abs(direction[axis])));
  }
  return range * direction.z() < 3.3 ? range : 0.0;
}

Eigen::Vector3d direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

void add_return(Scan& scan, const Eigen::Vector3d& direction) {
  const double range = range_in_yard(direction);
  if (range > 0.0) scan.points.push_back((range * direction).cast<float>());
}

Scan scan_of(const Head& head, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, head.noise);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Scan scan;
  const int columns = static_cast<int>(std::lround(head.width / head.step));
  for (std::size_t beam = 0; beam < head.elevations.size(); ++beam) {
    const double shift = head.shifts[beam % head.shifts.size()];
    for (int column = 0; column < columns; ++column) {
      const double azimuth = head.first + head.step * (column + head.phase + shift);
      const bool lost = unit(random) < head.missing;
      const double a = (azimuth + noise(random)) * kDegree;
      const double e = (head.elevations[beam] + noise(random)) * kDegree;
      if (!lost) add_return(scan, direction_of(a, e));
    }
  }
  return scan;
}

/// Five scans, each with columns at a place of its own.
std::vector<Scan> scans_of(Head head) {
  std::vector<Scan> scans;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    head.phase = 0.19 * seed;
    scans.push_back(scan_of(head, seed));
  }
  return scans;
}

/// A flower of two turning prisms in a cone of 70 degrees, as Livox sensors draw it.
std::vector<Scan> rosette_scans() {
  std::vector<Scan> scans(5);
  for (int scan = 0; scan < 5; ++scan) {
    for (int i = 0; i < 24000; ++i) {
      const double time = 0.1 * (scan + i / 24000.0), turn = 2.0 * std::numbers::pi;
      const double left = 17.6 * (std::cos(turn * 121.6 * time) + std::cos(turn * -77.7 * time));
      const double up = 17.6 * (std::sin(turn * 121.6 * time) + std::sin(turn * -77.7 * time));
      add_return(scans[static_cast<std::size_t>(scan)], direction_of(left * kDegree, up * kDegree));
    }
  }
  return scans;
}

void shuffle(std::vector<Scan>& scans, unsigned seed) {
  std::mt19937 random(seed);
  for (Scan& scan : scans) std::shuffle(scan.points.begin(), scan.points.end(), random);
}

/// The scans with their points in another frame.
std::vector<Scan> turned(std::vector<Scan> scans, const Eigen::Matrix3d& rotation) {
  for (Scan& scan : scans) turn_sensor_frame(rotation, scan);
  return scans;
}

Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// Bit for bit.
void check_same(const SensorModel& a, const SensorModel& b) {
  CHECK(a.azimuth_min == b.azimuth_min);
  CHECK(a.azimuth_max == b.azimuth_max);
  CHECK(a.elevation_min == b.elevation_min);
  CHECK(a.elevation_max == b.elevation_max);
  CHECK(a.azimuth_step == b.azimuth_step);
  CHECK(a.elevation_step == b.elevation_step);
  CHECK(a.range_min == b.range_min);
  CHECK(a.range_max == b.range_max);
  CHECK(a.beams == b.beams);
  CHECK(a.spin_axis == b.spin_axis);
  CHECK(a.basis == b.basis);
}

/// @param azimuth_step, elevation_step degrees
void check_steps(const SensorModel& model, double azimuth_step, double elevation_step,
                 double tolerance = 0.05) {
  INFO(model.basis);
  CHECK(model.azimuth_step == Approx(azimuth_step * kDegree).epsilon(tolerance));
  CHECK(model.elevation_step == Approx(elevation_step * kDegree).epsilon(tolerance));
}

Head vlp16() {
  return {.elevations = evenly(-15.0, 15.0, 16)};
}

}  // namespace

TEST_CASE("The order of points says nothing of a sensor", "[sensor-estimate][slow]") {
  Head block;
  block.elevations = evenly(-20.0, 5.0, 40);
  block.step = 0.4;
  std::vector<std::vector<Scan>> all = {scans_of(block), rosette_scans()};
  for (std::vector<Scan>& scans : all) {
    const SensorModel in_order = estimate_sensor_model(scans);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      shuffle(scans, seed);
      check_same(estimate_sensor_model(scans), in_order);
    }
  }
}

TEST_CASE("Even beams and columns are found", "[sensor-estimate]") {
  const SensorModel model = estimate_sensor_model(scans_of(vlp16()));
  check_steps(model, 0.2, 2.0);
  CHECK(model.beams == 16);
  CHECK(model.elevation_min == Approx(-15.0 * kDegree).margin(0.05 * kDegree));
  CHECK(model.elevation_max == Approx(15.0 * kDegree).margin(0.05 * kDegree));
  CHECK(model.full_circle());
  CHECK_THAT(model.basis, Contains("16 beams, 0.200 deg by") && Contains("from 5 scans with"));
}

TEST_CASE("Uneven beams are counted one by one", "[sensor-estimate]") {
  Head head;
  SECTION("two blocks, as in an HDL-64E") {
    head.elevations = evenly(-8.33, 2.0, 32);
    for (const double e : evenly(-24.87, -8.87, 32)) head.elevations.push_back(e);
    head.step = 0.1728;
    const SensorModel model = estimate_sensor_model(scans_of(head));
    check_steps(model, 0.1728, 26.87 / 63);
    CHECK(std::abs(model.beams - 64) <= 1);
  }
  SECTION("dense in the middle, as in a Pandar64") {
    head.elevations = evenly(-6.0, 2.0, 49);
    for (const double e : {3.0, 5.0, 8.0, 11.0, 15.0, -19.0, -25.0}) head.elevations.push_back(e);
    for (const double e : evenly(-14.0, -7.0, 8)) head.elevations.push_back(e);
    const SensorModel model = estimate_sensor_model(scans_of(head));
    check_steps(model, 0.2, 40.0 / 63);
    CHECK(std::abs(model.beams - 64) <= 2);
  }
}

TEST_CASE("A known sensor gets the bins of its data sheet", "[sensor-estimate]") {
  const SensorModel model = estimate_sensor_model(scans_of(vlp16()));
  const SensorModel named = sensor_model_named("vlp16");
  CHECK(model.name == "estimated");
  CHECK(model.azimuth_step == named.azimuth_step);
  CHECK(model.elevation_step == named.elevation_step);
  CHECK(model.elevation_min == named.elevation_min);
  CHECK(model.elevation_max == named.elevation_max);
  CHECK_THAT(model.basis, Contains("the data sheet of 'vlp16' fits and is used"));
  // 16 beams as far apart that look up are none of its.
  Head other = vlp16();
  other.elevations = evenly(-10.0, 20.0, 16);
  CHECK_THAT(estimate_sensor_model(scans_of(other)).basis, !Contains("data sheet"));
}

TEST_CASE("Columns that are shifted from beam to beam are no finer columns", "[sensor-estimate]") {
  // As an Ouster's, whose pixels look to the side by different angles.
  Head head;
  head.elevations = evenly(-22.5, 22.5, 64);
  head.step = 0.35;
  head.shifts = {0.0, 0.25, 0.5, 0.75};
  const SensorModel model = estimate_sensor_model(scans_of(head));
  check_steps(model, 0.35, 45.0 / 63);
  CHECK(std::abs(model.beams - 64) <= 1);
}

TEST_CASE("Several revolutions in a scan show the steps of one", "[sensor-estimate]") {
  Head head;
  head.elevations = evenly(-25.0, 10.0, 32);
  SECTION("two, whose columns do not line up") {
    std::vector<Scan> scans = scans_of(head);
    for (unsigned i = 0; i < 5; ++i) {
      head.phase = 0.19 * (i + 1) + 0.37;
      for (const auto& point : scan_of(head, 10 + i).points) scans[i].points.push_back(point);
    }
    check_steps(estimate_sensor_model(scans), 0.2, 35.0 / 31);
  }
  SECTION("one and a tenth") {
    head.width = 395.0;
    const SensorModel model = estimate_sensor_model(scans_of(head));
    check_steps(model, 0.2, 35.0 / 31);
    CHECK(model.full_circle());
  }
  SECTION("three, on average closer than one") {
    std::vector<Scan> scans = scans_of(head);
    for (unsigned i = 0; i < 10; ++i) {
      head.phase = 0.19 * (i + 1) + (i < 5 ? 0.31 : 0.72);
      for (const auto& point : scan_of(head, 20 + i).points) scans[i % 5].points.push_back(point);
    }
    const SensorModel model = estimate_sensor_model(scans);
    INFO(model.basis);
    CHECK(model.azimuth_step > 0.06 * kDegree);
    CHECK(model.azimuth_step < 0.25 * kDegree);
    CHECK(model.elevation_step == Approx(35.0 / 31 * kDegree).epsilon(0.1));
  }
}

TEST_CASE("A field of view may go across the back", "[sensor-estimate]") {
  Head head = vlp16();
  head.first = 150.0;
  head.width = 60.0;
  const SensorModel model = estimate_sensor_model(scans_of(head));
  check_steps(model, 0.2, 2.0);
  CHECK(model.azimuth_min == Approx(150.0 * kDegree).margin(0.5 * kDegree));
  CHECK(model.azimuth_max == Approx(210.0 * kDegree).margin(0.5 * kDegree));
  CHECK_FALSE(model.full_circle());
  CHECK(model.sees(170.0 * kDegree, 0.0));
  CHECK(model.sees(-170.0 * kDegree, 0.0));
  CHECK_FALSE(model.sees(0.0, 0.0));
  CHECK_FALSE(model.sees(140.0 * kDegree, 0.0));
  CHECK_FALSE(model.sees(170.0 * kDegree, 0.5));
}

TEST_CASE("A rosette has the spacing of its directions in one scan", "[sensor-estimate]") {
  // 24,000 directions in a cone of 70 degrees have 0.4 degrees each if they are spread evenly;
  // where there are any, they are closer.
  const SensorModel model = estimate_sensor_model(rosette_scans());
  INFO(model.basis);
  CHECK(model.beams == 0);
  CHECK(model.azimuth_step == model.elevation_step);
  CHECK(model.azimuth_step > 0.15 * kDegree);
  CHECK(model.azimuth_step < 0.5 * kDegree);
  CHECK_THAT(model.basis, Contains("neither beams nor columns"));
}

TEST_CASE("A scan that was thinned out has the spacing of what is left", "[sensor-estimate]") {
  Head head;
  head.elevations = evenly(-25.0, 3.0, 64);
  head.missing = 0.9;
  const SensorModel model = estimate_sensor_model(scans_of(head));
  // A direction in ten: 0.2 by 0.444 degrees for each of all, ten times that for each of the rest.
  const double spacing = std::sqrt(model.azimuth_step * model.elevation_step) / kDegree;
  INFO(model.basis);
  CHECK(spacing > 0.5 * std::sqrt(10 * 0.2 * 28.0 / 63));
  CHECK(spacing < 1.5 * std::sqrt(10 * 0.2 * 28.0 / 63));
}

TEST_CASE("The spin axis is found in any frame of the points", "[sensor-estimate][slow]") {
  Head wide = vlp16(), dense, shifted;
  wide.first = -60.0;
  wide.width = 120.0;
  dense.elevations = evenly(-11.0, 11.0, 67);  // Beams are half as far apart as columns.
  dense.step = 0.7;
  shifted.elevations = evenly(-22.5, 22.5, 64);  // As an Ouster's, as far apart as columns.
  shifted.step = 0.7;
  shifted.shifts = {0.0, 0.25, 0.5, 0.75};
  std::mt19937 random(7);
  for (const Head& head : {vlp16(), wide, dense, shifted}) {
    const std::vector<Scan> upright = scans_of(head);
    const SensorModel model = estimate_sensor_model(upright);
    INFO(model.basis);
    CHECK(model.spin_axis == Eigen::Vector3d::UnitZ());
    CHECK_THAT(model.basis, !Contains("spin axis"));
    for (int round = 0; round < 2; ++round) {
      const Eigen::Matrix3d rotation = random_rotation(random);
      const SensorModel seen = estimate_sensor_model(turned(upright, rotation));
      INFO(seen.basis);
      // Either side of a field of view that is the same on both may be its upper side.
      const double cosine = std::abs(seen.spin_axis.dot(rotation.col(2)));
      CHECK(std::acos(std::min(1.0, cosine)) < 0.1 * kDegree);
      CHECK(seen.beams == Approx(model.beams).margin(2));
      check_steps(seen, model.azimuth_step / kDegree, model.elevation_step / kDegree);
    }
  }
}

TEST_CASE("The coordinate axis that points are turned about is the spin axis, exactly",
          "[sensor-estimate]") {
  const std::vector<Scan> upright = scans_of(vlp16());
  const SensorModel model = estimate_sensor_model(upright);
  Eigen::Matrix3d z_to_y;
  z_to_y << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const SensorModel seen = estimate_sensor_model(turned(upright, z_to_y));
  CHECK(seen.spin_axis == Eigen::Vector3d::UnitY());
  CHECK(seen.basis == model.basis + "; spin axis: y");
  CHECK(seen.beams == model.beams);
  CHECK(seen.elevation_min == model.elevation_min);
  CHECK(estimate_spin_axis(turned(upright, z_to_y)) == Eigen::Vector3d::UnitY());
  // As in a camera's frame. The ground, with more returns than the air, is on the other side.
  Eigen::Matrix3d z_to_minus_y;
  z_to_minus_y << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  CHECK(estimate_sensor_model(turned(upright, z_to_minus_y)).basis ==
        model.basis + "; spin axis: -y");
}

TEST_CASE("A sensor that is not quite upright keeps z", "[sensor-estimate]") {
  // A calibration of half a degree is none of a frame; three degrees are.
  const std::vector<Scan> upright = scans_of(vlp16());
  const auto tilted = [&](double degrees) {
    const Eigen::AngleAxisd tilt(degrees * kDegree, Eigen::Vector3d::UnitX());
    return estimate_sensor_model(turned(upright, tilt.toRotationMatrix())).spin_axis;
  };
  CHECK(tilted(0.5) == Eigen::Vector3d::UnitZ());
  CHECK(std::acos(tilted(3.0).z()) == Approx(3.0 * kDegree).margin(0.1 * kDegree));
}

TEST_CASE("Scans without beams have no spin axis but z", "[sensor-estimate]") {
  std::mt19937 random(5);
  const std::vector<Scan> rosette = rosette_scans();
  for (int round = 0; round < 3; ++round) {
    const SensorModel seen = estimate_sensor_model(turned(rosette, random_rotation(random)));
    CHECK(seen.spin_axis == Eigen::Vector3d::UnitZ());
    CHECK(seen.beams == 0);
  }
  std::normal_distribution<float> anywhere(0.0F, 1.0F);
  std::vector<Scan> noise(5);
  for (Scan& scan : noise) {
    for (int i = 0; i < 5000; ++i) {
      scan.points.emplace_back(anywhere(random), anywhere(random), anywhere(random));
    }
  }
  CHECK(estimate_sensor_model(noise).spin_axis == Eigen::Vector3d::UnitZ());
  CHECK(estimate_spin_axis(noise) == Eigen::Vector3d::UnitZ());
  CHECK(estimate_spin_axis({Scan{}, Scan{}}) == Eigen::Vector3d::UnitZ());
}

TEST_CASE("A scan of nothing but ground shows the beams that meet it", "[sensor-estimate]") {
  Head head;
  head.elevations = evenly(-24.0, -8.0, 17);
  std::vector<Scan> scans = scans_of(head);
  for (Scan& scan : scans) {
    std::erase_if(scan.points, [](const Eigen::Vector3f& p) { return p.z() > -1.6F; });
  }
  const SensorModel model = estimate_sensor_model(scans);
  check_steps(model, 0.2, 1.0);
  CHECK(model.elevation_max < -7.5 * kDegree);
}

TEST_CASE("Two returns of a direction are one direction", "[sensor-estimate]") {
  std::vector<Scan> scans = scans_of(vlp16());
  const SensorModel single = estimate_sensor_model(scans);
  for (Scan& scan : scans) {
    const std::size_t count = scan.size();
    for (std::size_t i = 0; i < count; ++i) scan.points.push_back(0.5F * scan.points[i]);
  }
  const SensorModel twice = estimate_sensor_model(scans);
  CHECK(twice.azimuth_step == single.azimuth_step);
  CHECK(twice.elevation_step == single.elevation_step);
}
