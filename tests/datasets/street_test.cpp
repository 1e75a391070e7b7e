// SPDX-License-Identifier: MIT
#include "datasets/simulation/street/street.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/fingerprint.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// One beam at `elevation_deg` with `columns` directions, 2 m above the ground.
StreetParameters one_beam(double elevation_deg, int columns) {
  StreetParameters parameters;
  parameters.scans = 3;
  parameters.sensor_height = 2.0;
  parameters.beams = 1;
  parameters.elevation_min_deg = parameters.elevation_max_deg = elevation_deg;
  parameters.columns = columns;
  return parameters;
}

/// World points of scan `index`.
std::vector<Eigen::Vector3d> world_points(const Sequence& sequence, std::size_t index) {
  const Scan scan = sequence.scans->load(index);
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : scan.points)
    points.push_back(scan.T_world_sensor * point.cast<double>());
  return points;
}

/// Distance of `point` to the surface of `box` at time `time_s`.
double distance_to_surface(const StreetBox& box, double time_s, const Eigen::Vector3d& point) {
  const Eigen::Vector3d centre = 0.5 * (box.min + box.max) + box.velocity * time_s;
  const Eigen::Vector3d beyond = (point - centre).cwiseAbs() - 0.5 * (box.max - box.min);
  return std::abs(beyond.maxCoeff());
}

}  // namespace

TEST_CASE("a beam at 30 degrees down meets the ground at twice its height", "[street]") {
  // range = height / sin 30 = 4 m in every direction.
  const Sequence sequence = make_street(one_beam(-30.0, 8), {});
  const Scan scan = sequence.scans->load(2);
  REQUIRE(scan.size() == 8);
  for (const auto& point : scan.points) {
    CHECK(point.norm() == Approx(4.0));
    CHECK(point.z() == Approx(-2.0));
  }
  CHECK(scan.T_world_sensor.translation() == Eigen::Vector3d(2, 0, 2));
  CHECK(scan.time_s == Approx(0.2));
  CHECK(scan.name == "000002");
  CHECK(sequence.labels->labels(scan) == std::vector<std::uint32_t>(8, 40));
}

TEST_CASE("a level beam meets a moving box where it stands then", "[street]") {
  // Four directions: -x, -y, +x, +y. The box starts 10 m ahead and comes at 5 m/s (0.5 m a scan)
  // while the sensor moves 1 m per scan: 10, 8.5, 7 m.
  const StreetBox box{{10, -1, 0}, {12, 1, 4}, {-5, 0, 0}, (9U << 16U) | 252U};
  const Sequence sequence = make_street(one_beam(0.0, 4), {box});
  for (std::size_t i = 0; i < 3; ++i) {
    const Scan scan = sequence.scans->load(i);
    REQUIRE(scan.size() == 1);
    CHECK(scan.points[0].x() == Approx(10.0 - 1.5 * static_cast<double>(i)));
    CHECK(std::abs(scan.points[0].y()) < 1e-5F);
    CHECK(sequence.labels->labels(scan) == std::vector<std::uint32_t>{box.label});
  }
}

TEST_CASE("every point of the street lies on what its label says", "[street]") {
  const Sequence sequence = open_sequence("street", {});
  REQUIRE(sequence.scans->size() == 50);
  CHECK(sequence.layout == "simulated");
  std::map<std::uint32_t, std::size_t> seen;
  for (const std::size_t index : {0U, 20U, 33U, 49U}) {
    const Scan scan = sequence.scans->load(index);
    const auto points = world_points(sequence, index);
    const auto labels = sequence.labels->labels(scan);
    REQUIRE(labels.size() == points.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double nearest = labels[i] == 40 ? std::abs(points[i].z()) : 1e9;
      for (const StreetBox& box : street_boxes()) {
        if (box.label != labels[i]) continue;
        nearest = std::min(nearest, distance_to_surface(box, scan.time_s, points[i]));
      }
      if (nearest > 1e-4 || scan.points[i].norm() > 60.001F) ++wrong;
      ++seen[labels[i]];
    }
    CHECK(wrong == 0);
  }
  std::set<std::uint32_t> semantic;
  for (const auto& [word, count] : seen) semantic.insert(word & 0xFFFFU);
  CHECK(semantic == std::set<std::uint32_t>{10, 40, 50, 80, 252, 254});
}

TEST_CASE("the street is seen by beams of its sensor model, each at most once", "[street]") {
  const Sequence sequence = open_sequence("street", {});
  const SensorModel& sensor = sequence.scans->sensor();
  CHECK(sensor.missing_return_is_meaningful);
  CHECK(sensor.azimuth_step == Approx(0.5 * std::numbers::pi / 180.0));
  std::set<std::pair<long, long>> beams;
  const Scan scan = sequence.scans->load(10);
  double worst = 0.0;
  for (const auto& point : scan.points) {
    const Eigen::Vector3d p = point.cast<double>();
    const double row = (std::asin(p.z() / p.norm()) - sensor.elevation_min) / sensor.elevation_step;
    const double column = (std::atan2(p.y(), p.x()) + std::numbers::pi) / sensor.azimuth_step;
    worst =
        std::max({worst, std::abs(row - std::round(row)), std::abs(column - std::round(column))});
    beams.emplace(std::lround(row), std::lround(column) % 720);
  }
  CHECK(worst < 1e-3);
  CHECK(beams.size() == scan.size());
}

TEST_CASE("the street is the same at every call and opens by frames", "[street][slow]") {
  const Sequence sequence = open_sequence("street", {});
  CHECK(fingerprint(sequence, 1) == fingerprint(open_sequence("street", {}), 2));
  SequenceOptions options;
  options.frames = parse_frame_range("10:20:5");
  const Sequence part = open_sequence("street", options);
  REQUIRE(part.scans->size() == 3);
  CHECK(part.frames == "10:20:5");
  CHECK(part.scans->load(1).points == sequence.scans->load(15).points);
  CHECK(part.scans->load(1).index == 1);
  CHECK(part.labels->labels(part.scans->load(1)) ==
        sequence.labels->labels(sequence.scans->load(15)));
}
