// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/beam_image.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>

#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;
using namespace raymoval::raymoval_plus_method;

namespace {

/// A voxel whose points deviate equally in all directions, metres.
VoxelShape ball(float deviation, float nearest = 10.0F) {
  VoxelShape shape;
  shape.xx = shape.yy = shape.zz = 1.0F / (deviation * deviation);
  shape.radius = deviation;
  shape.nearest = nearest;
  return shape;
}

/// A sensor with rows 2 degrees apart, of which each has two rows of bins, and columns 1 degree
/// apart. It sees 40 degrees up and down.
SensorModel wide_sensor() {
  SensorModel sensor;
  sensor.elevation_min = -40.0 * kDegree;
  sensor.elevation_max = 40.0 * kDegree;
  sensor.azimuth_step = kDegree;
  sensor.elevation_step = 2.0 * kDegree;
  return sensor;
}

/// Beams by azimuth and elevation, degrees, and range, metres.
Scan beams(const std::vector<std::array<double, 3>>& all) {
  Scan scan;
  for (const auto& [azimuth, elevation, range] : all) {
    scan.points.emplace_back(
        (range * direction(azimuth * kDegree, elevation * kDegree)).cast<float>());
  }
  return scan;
}

/// What a scan observes of voxels in the world.
std::vector<Observation> observations(const Scan& scan, const std::vector<Eigen::Vector3d>& places,
                                      const std::vector<VoxelShape>& shapes,
                                      const SensorModel& sensor = wide_sensor(),
                                      const Parameters& parameters = {}) {
  BeamImage image(sensor, parameters);
  image.fill(scan);
  const Eigen::Vector3d origin(7.0, -3.0, 1.0);
  std::vector<float> offsets;
  for (const Eigen::Vector3d& place : places) {
    for (int axis = 0; axis < 3; ++axis) {
      offsets.push_back(static_cast<float>(place[axis] - origin[axis]));
    }
  }
  std::vector<ObservedVoxel> observed;
  image.observe(offsets, shapes, origin, observed);
  std::vector<Observation> all(places.size(), Observation::kUnknown);
  for (const ObservedVoxel& voxel : observed) all[voxel.place] = voxel.observation;
  return all;
}

Observation observation(const Scan& scan, const Eigen::Vector3d& place, const VoxelShape& shape,
                        const Parameters& parameters = {}) {
  return observations(scan, {place}, {shape}, wide_sensor(), parameters)[0];
}

}  // namespace

TEST_CASE("a beam that ends at a voxel hits it, and one that ends well behind passes it") {
  // 10 m away, 0.2 m + 0.05 m are near enough for a hit, and 0.25 m + 0.05 m behind for a pass.
  using enum Observation;
  for (const auto& [range, seen] :
       {std::pair{9.7, kUnknown}, std::pair{9.8, kHit}, std::pair{10.2, kHit},
        std::pair{10.27, kUnknown}, std::pair{10.35, kPassed}, std::pair{60.0, kPassed}}) {
    CAPTURE(range);
    CHECK(observation(beams({{0.3, 0.3, range}}), 10.0 * direction(0.3 * kDegree, 0.3 * kDegree),
                      ball(0.1F)) == seen);
  }
  const Eigen::Vector3d place = 10.0 * direction(0.0, 0.005);
  CHECK(observation(beams({{0.0, 0.3, 20.0}, {0.3, 0.3, 20.0}, {0.2, 0.2, 10.0}}), place,
                    ball(0.1F)) == kHit);  // One hit outweighs all passes.
  CHECK(observation(beams({{0.0, 0.3, 20.0}, {0.2, 0.2, 5.0}}), place, ball(0.1F)) == kPassed);
  CHECK(observation(beams({{0.0, 0.3, 9.0}, {0.2, 0.2, 5.0}}), place, ball(0.1F)) == kUnknown);
}

TEST_CASE("a beam crosses a voxel within one standard deviation of its points") {
  // A voxel 20 m away, 0.1 m wide and 0.4 m high, and beams beside it.
  VoxelShape tall = ball(0.1F);
  tall.zz = 1.0F / 0.16F;
  tall.radius = 0.4F;
  const double degrees = 1.0 / (20.0 * kDegree);
  for (const auto& [aside, up, is_crossed] :
       {std::tuple{0.09, 0.0, true}, std::tuple{-0.09, 0.0, true}, std::tuple{0.11, 0.0, false},
        std::tuple{0.0, 0.38, true}, std::tuple{0.0, -0.38, true}, std::tuple{0.0, 0.42, false},
        std::tuple{0.08, 0.3, false}}) {
    CAPTURE(aside, up);
    const Scan scan = beams({{aside * degrees, up * degrees, 30.0}});
    CHECK((observation(scan, {20.0, 0.0, 0.0}, tall) == Observation::kPassed) == is_crossed);
  }
}

TEST_CASE("a beam that ends at a voxel hits it within sqrt(3) standard deviations") {
  const Eigen::Vector3d ray = direction(0.5 * kDegree, 0.0), left(-ray.y(), ray.x(), 0.0);
  for (const double aside : {-0.17, 0.17, -0.18, 0.18}) {
    const Observation seen =
        observation(beams({{0.5, 0.0, 10.0}}), 10.0 * ray + aside * left, ball(0.1F));
    CHECK((seen == Observation::kHit) == (std::abs(aside) < std::sqrt(0.03)));
  }
}

TEST_CASE("only voxels in the evidence range are tested, and no returns from the ego vehicle") {
  Parameters parameters;
  parameters.evidence_range_min = 5.0;
  parameters.evidence_range_max = 15.0;
  for (const auto& [nearest, range, is_tested] :
       {std::tuple{2.0, 4.9, false}, std::tuple{2.0, 5.1, true}, std::tuple{2.0, 14.9, true},
        std::tuple{2.0, 15.1, false}, std::tuple{30.0, 10.0, false}}) {
    parameters.minimum_range = nearest;
    const Scan scan = beams({{0.0, 0.0, 20.0}});
    CHECK((observation(scan, {range, 0.0, 0.0}, ball(0.1F), parameters) != Observation::kUnknown) ==
          is_tested);
  }
}

TEST_CASE("a beam passes a flat voxel if it ends behind its plane") {
  // Level ground 1 m below a sensor, 10 m ahead. A beam through the voxel is 1.05 m lower at 1.05
  // times its range, and 1.2 m at 1.2 times. It must end 0.14 m below the plane.
  using enum Observation;
  for (const bool is_flat : {true, false}) {
    for (const float up : {1.0F, -1.0F}) {  // Either normal.
      VoxelShape ground = ball(0.1F);
      ground.nz = up;
      ground.behind = is_flat ? 0.14F : 0.0F;
      const Eigen::Vector3d place(10.0, 0.0, -1.0);
      const double elevation = std::atan(-0.1) / kDegree, range = place.norm();
      CHECK(observation(beams({{0.0, elevation, 1.05 * range}}), place, ground) ==
            (is_flat ? kUnknown : kPassed));
      CHECK(observation(beams({{0.0, elevation, 1.2 * range}}), place, ground) == kPassed);
    }
  }
}

TEST_CASE("a voxel between rows of beams that end behind it is open") {
  // Rows 1.3 degrees above a voxel 10 m away and 1.1 degrees below it do not cross it. Two rows of
  // bins, 2 degrees, are 0.35 m there, and 0.17 m at 5 m.
  using enum Observation;
  const auto seen = [](double above, double below, double range, float nearest) {
    const Scan scan = beams({{0.3, 1.4, above}, {0.3, -1.0, below}});
    return observation(scan, range * direction(0.3 * kDegree, 0.1 * kDegree), ball(0.02F, nearest));
  };
  CHECK(seen(20.0, 20.0, 10.0, 10.0F) == kOpen);
  CHECK(seen(20.0, 10.2, 10.0, 10.0F) == kUnknown);  // One ends at the voxel's range.
  CHECK(seen(20.0, 0.1, 10.0, 10.0F) == kUnknown);   // One is missing, being of the ego vehicle.
  CHECK(seen(0.1, 20.0, 10.0, 10.0F) == kUnknown);
  CHECK(seen(20.0, 20.0, 5.0, 10.0F) == kUnknown);  // The rows are near each other.
  CHECK(seen(20.0, 20.0, 10.0, 7.0F) == kOpen);
  CHECK(seen(20.0, 20.0, 10.0, 6.0F) == kUnknown);  // Farther than 1.5 x 6 m.
}

TEST_CASE("a surface goes on between beams that are far apart and end at about the same range") {
  // Columns a degree apart are 0.35 m apart at 20 m, and 0.09 m at 5 m. Ranges may differ by 0.2 m
  // more than that.
  BeamImage image(wide_sensor(), Parameters{});
  std::vector<BeamImage::Extension> extensions;
  for (const auto& [near, far, count] :
       {std::tuple{20.0, 20.6, 0U}, std::tuple{5.0, 5.0, 0U}, std::tuple{20.0, 20.5, 2U}}) {
    Scan scan = beams({{10.5, 0.5, near}, {11.5, 0.5, far}, {90.5, 0.5, 20.0}});
    scan.T_world_sensor.linear() =
        Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
    image.fill(scan);
    image.find_extensions(extensions);
    REQUIRE(extensions.size() == count);
    const Eigen::Vector3f third =
        scan.T_world_sensor.linear().cast<float>() * (scan.points[1] - scan.points[0]) / 3.0F;
    for (const auto& [point, offset] : extensions) {
      CHECK(offset.isApprox(point == 0 ? third : -third, 1e-3F));
    }
  }
  CHECK(extensions[0].point + extensions[1].point == 1);
}

namespace {

/// What all beams of a scan say of a voxel, in double precision and without bins. Beams that come
/// within sqrt(3) standard deviations hit a voxel if the image finds them; within one it must.
struct AllBeams {
  bool hit = false, may_hit = false, passed = false, may_pass = false;

  AllBeams(const Scan& scan, const Eigen::Vector3d& place, const VoxelShape& shape) {
    constexpr double kSure = 1e-3;
    const Eigen::Vector3d m = place - scan.T_world_sensor.translation();
    const double slope = 0.005 * m.norm();
    Eigen::Matrix3d inverse;
    inverse << shape.xx, shape.xy, shape.xz, shape.xy, shape.yy, shape.yz, shape.xz, shape.yz,
        shape.zz;
    const Eigen::Vector3d normal(shape.nx, shape.ny, shape.nz);
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d end = scan.T_world_sensor.linear() * point.cast<double>();
      const Eigen::Vector3d u = end.normalized();
      if (u.dot(m) < 0.99 * m.norm()) continue;  // Eight degrees aside.
      const double nearest = u.dot(inverse * m) / u.dot(inverse * u);
      const Eigen::Vector3d off = nearest * u - m;
      const double aside = off.dot(inverse * off), behind = end.norm() - nearest;
      const double deep =
          shape.behind == 0.0F
              ? 1e9
              : (normal.dot(m) > 0.0 ? 1.0 : -1.0) * normal.dot(end - m) - shape.behind;
      const double near = 0.2 + slope - std::abs(behind);
      const double far = std::min(behind - 0.25 - slope, deep);
      hit |= aside < 1.0 - kSure && near > kSure;
      may_hit |= aside < 3.0 + kSure && near > -kSure;
      passed |= aside < 1.0 - kSure && far > kSure;
      may_pass |= aside < 1.0 + kSure && far > -kSure;
    }
  }
};

/// A random voxel, flat if two of its axes are much longer than the third.
VoxelShape random_shape(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0), deviation(0.04, 0.12);
  const Eigen::Matrix3d axes =
      Eigen::Quaterniond(number(random), number(random), number(random), number(random))
          .normalized()
          .toRotationMatrix();
  Eigen::Vector3d deviations(deviation(random), deviation(random), deviation(random));
  const bool is_flat = random() % 2 == 0;
  if (is_flat) deviations.x() = 0.04;
  const Eigen::Matrix3d covariance = axes * deviations.cwiseAbs2().asDiagonal() * axes.transpose(),
                        inverse = covariance.inverse();
  const auto f = [](double value) { return static_cast<float>(value); };
  VoxelShape shape{f(inverse(0, 0)), f(inverse(1, 1)), f(inverse(2, 2)),
                   f(inverse(0, 1)), f(inverse(0, 2)), f(inverse(1, 2))};
  if (is_flat) {
    shape.nx = f(axes(0, 0)), shape.ny = f(axes(1, 0)), shape.nz = f(axes(2, 0));
    shape.behind = 0.14F;
  }
  shape.radius = f(std::sqrt(covariance.cwiseAbs().rowwise().sum().maxCoeff()));
  return shape;
}

}  // namespace

TEST_CASE("observations are those of a test of all beams, however the sensor is turned") {
  // The same beams in the world, of a sensor with level rows, with rows that stand upright, and
  // turned by any angle. Beams are given to the image in the axes of the sensor.
  const auto [angle, axis] = GENERATE(
      std::pair(0.0, Eigen::Vector3d(0, 0, 1)), std::pair(90.0, Eigen::Vector3d(1, 0, 0)),
      std::pair(90.0, Eigen::Vector3d(0, 0, 1)), std::pair(77.0, Eigen::Vector3d(1, 2, 3)));
  SensorModel sensor = wide_sensor();
  sensor.elevation_min = -90.0 * kDegree;
  sensor.elevation_max = 90.0 * kDegree;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0), range(2.0, 12.0), place(2.5, 9.0);
  Scan scan;
  scan.T_world_sensor =
      Eigen::Translation3d(3.0, -2.0, 0.5) * Eigen::AngleAxisd(angle * kDegree, axis.normalized());
  const auto random_direction = [&] {
    return Eigen::Vector3d(number(random), number(random), number(random)).normalized();
  };
  for (int i = 0; i < 40'000; ++i) {
    const Eigen::Vector3d ray = scan.T_world_sensor.linear().transpose() * random_direction();
    scan.points.push_back((range(random) * ray).cast<float>());
  }
  std::vector<Eigen::Vector3d> places;
  std::vector<VoxelShape> shapes;
  for (int i = 0; i < 1500; ++i) {
    places.emplace_back(scan.T_world_sensor.translation() + place(random) * random_direction());
    shapes.push_back(random_shape(random));
  }
  const std::vector<Observation> observed = observations(scan, places, shapes, sensor);
  std::map<Observation, int> sure;
  for (std::size_t v = 0; v < places.size(); ++v) {
    const Eigen::Vector3d m = scan.T_world_sensor.inverse() * places[v];
    if (std::abs(m.z()) > 0.95 * m.norm()) continue;  // Columns end above and below the sensor.
    const AllBeams all(scan, places[v], shapes[v]);
    CAPTURE(v, all.hit, all.may_hit, all.passed, all.may_pass);
    const Observation seen =
        observed[v] == Observation::kOpen ? Observation::kUnknown : observed[v];
    CHECK((seen == Observation::kHit ? all.may_hit : !all.hit));
    if (!all.may_hit) CHECK((seen == Observation::kPassed ? all.may_pass : !all.passed));
    const bool is_sure = all.hit || (!all.may_hit && all.passed == all.may_pass);
    if (is_sure) ++sure[seen];
  }
  for (const Observation each : {Observation::kHit, Observation::kPassed, Observation::kUnknown}) {
    CHECK(sure[each] > 100);
  }
}

}  // namespace raymoval::raymoval_plus_test
