// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/range_image.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "core/simd/instruction_set_scope.h"
#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;
using namespace raymoval::raymoval_plus_method;

namespace {

/// The image of a scan of some points, by a sensor with steps of half a degree.
RangeImage image_of(std::vector<Eigen::Vector3f> points,
                    const SensorModel& sensor = Scanner{}.model(),
                    const Pose& T_world_sensor = Pose::Identity()) {
  Scan scan;
  scan.points = std::move(points);
  scan.T_world_sensor = T_world_sensor;
  RangeImage image(sensor, Parameters{});
  image.fill(scan);
  return image;
}

/// The same sensor with known beams.
SensorModel sensor_with_beams() {
  SensorModel sensor = Scanner{}.model();
  sensor.beams = 41;
  return sensor;
}

/// The same sensor with beams up to `degrees` up and down.
SensorModel sensor_within(double degrees, double step = 0.5) {
  SensorModel sensor = Scanner{}.model();
  sensor.elevation_min = -degrees * kDegree;
  sensor.elevation_max = degrees * kDegree;
  sensor.elevation_step = step * kDegree;
  return sensor;
}

/// Every instruction set with every rule for free observations.
std::vector<std::pair<InstructionSet, SeenThrough>> sets_and_rules() {
  std::vector<std::pair<InstructionSet, SeenThrough>> all;
  for (const InstructionSet set : supported_instruction_sets()) {
    all.emplace_back(set, SeenThrough::kInRowOrBelow);
    all.emplace_back(set, SeenThrough::kAtOrBelow);
  }
  return all;
}

/// Places around the middle of a bin of `image_of`: bins are half a degree times 1.45 wide and a
/// quarter of a degree high.
struct AroundBin {
  double elevation;  ///< Of the bin's middle, radians.

  /// @param aside columns, @param up rows from the bin
  [[nodiscard]] Eigen::Vector3f at(double range, double aside, double up) const {
    const int columns = static_cast<int>(std::round(360.0 / (1.45 * 0.5)));
    const double column = 360.0 / columns * kDegree;
    const double azimuth = (columns / 2 + 0.5 + aside) * column - std::numbers::pi;
    return (range * direction(azimuth, elevation + up * 0.25 * kDegree)).cast<float>();
  }
};

}  // namespace

TEST_CASE("a place agrees with, hides behind or stands in front of a return") {
  const RangeImage image = image_of({{10.0F, 0.0F, 0.0F}});
  CHECK(image.observe({10.1F, 0.0F, 0.0F}) == Observation::kAgree);     // 0.1 <= 0.2 + 0.005 * 10.1
  CHECK(image.observe({11.0F, 0.0F, 0.0F}) == Observation::kOccluded);  // the return is 1 m nearer
  CHECK(image.observe({5.0F, 0.0F, 0.0F}) == Observation::kFree);       // it is 5 m farther
  // 0.27 m is more than 0.2 + 0.005 * 9.73, but 10 < 9.73 + 0.25 + 0.005 * 9.73.
  CHECK(image.observe({9.73F, 0.0F, 0.0F}) == Observation::kOccluded);
  CHECK(image.observe({0.0F, 5.0F, 0.0F}) == Observation::kUnknown);  // no return that way
}

TEST_CASE("steps that no sensor has cost no more memory than the finest sensor") {
  for (const double step : {0.0, 1e-300, 1e-9, 1e-4, 3.0}) {
    INFO(step);
    SensorModel sensor = Scanner{}.model();
    sensor.elevation_min = -1.6;
    sensor.elevation_max = 1.6;
    sensor.azimuth_step = sensor.elevation_step = step;
    const RangeImage image = image_of({{10.0F, 0.0F, 0.0F}}, sensor);
    CHECK(image.size() <= 4'000'000);
    CHECK(image.size() >= 90);
    CHECK(image.observe({10.0F, 0.0F, 0.0F}) == Observation::kAgree);
  }
}

TEST_CASE("rows are half a beam high, wherever the field of view ends") {
  // 16 beams 2 degrees apart are 30 rows of 1 degree, and 4 more at either end.
  SensorModel sensor = sensor_within(15.0, 2.0);
  sensor.azimuth_step = 0.2 * kDegree;
  CHECK(image_of({}, sensor).size() == 38 * 1241);
  sensor.elevation_max += 0.3 * kDegree;
  CHECK(image_of({}, sensor).size() == 39 * 1241);
}

TEST_CASE("agreement saves before occlusion abstains before freedom counts") {
  const RangeImage image = image_of({{4.0F, 0.0F, 0.0F}, {10.0F, 0.0F, 0.0F}, {30.0F, 0.0F, 0.0F}});
  CHECK(image.observe({30.0F, 0.0F, 0.0F}) == Observation::kAgree);     // the farthest of the bin
  CHECK(image.observe({10.0F, 0.0F, 0.0F}) == Observation::kOccluded);  // a middle one is not kept
  CHECK(image.observe({3.0F, 0.0F, 0.0F}) == Observation::kFree);
}

TEST_CASE("a return above a place does not make it free") {
  // Two rows of half a step above the place: within the window, not at or below it.
  const float slope = std::tan(0.5F * 0.01745329F);
  const RangeImage image = image_of({{10.0F, 0.0F, 10.0F * slope}});
  CHECK(image.observe({5.0F, 0.0F, 0.0F}) == Observation::kUnknown);
  CHECK(image.observe({5.0F, 0.0F, 5.0F * slope}) == Observation::kFree);
}

TEST_CASE("a beam that passes above a place of the ground does not see through it") {
  // Rows are a quarter of a degree high; the place is in the middle of one.
  const SensorModel sensor = Scanner{}.model();
  const double middle = sensor.elevation_min + (8.0 + 0.5) * 0.25 * kDegree;
  const Eigen::Vector3f place = (40.0 * direction(0.0, middle)).cast<float>();
  const auto seen_by = [&](double beam, SeenThrough seen) {
    return image_of({(60.0 * direction(0.0, beam)).cast<float>()}, sensor).observe(place, seen);
  };
  for (const SeenThrough seen : {SeenThrough::kInRowOrBelow, SeenThrough::kAtOrBelow}) {
    const bool may_pass_above = seen == SeenThrough::kInRowOrBelow;
    CHECK(seen_by(middle - 0.1 * kDegree, seen) == Observation::kFree);
    CHECK(seen_by(middle, seen) == Observation::kFree);
    CHECK(seen_by(middle + 0.1 * kDegree, seen) ==
          (may_pass_above ? Observation::kFree : Observation::kUnknown));
  }
}

TEST_CASE("what is above is so in the world, whichever way the sensor is turned") {
  // The sensor lies on its right side, so that its y is up: the beam at a greater azimuth is above.
  const double elevation = Scanner{}.model().elevation_min + (8.0 + 0.5) * 0.25 * kDegree;
  const Pose lying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3f place = (40.0 * direction(0.0, elevation)).cast<float>();
  for (const double side : {-0.2, 0.2}) {
    const RangeImage image = image_of({(60.0 * direction(side * kDegree, elevation)).cast<float>()},
                                      Scanner{}.model(), lying);
    CHECK(image.observe(place, SeenThrough::kInRowOrBelow) == Observation::kFree);
    CHECK(image.observe(place, SeenThrough::kAtOrBelow) ==
          (side < 0.0 ? Observation::kFree : Observation::kUnknown));
  }
}

TEST_CASE("a scan sees through a place beside what is nearer, in its own column of bins") {
  // The place is in the middle of a bin, 20 m away. A person is 10 m away in the column beside it.
  // Without a gap, a return is beyond from 20 + 0.25 + 0.005 * 20 = 20.35 m on; in a gap, from 1 m
  // farther on.
  const SensorModel sensor = Scanner{}.model();
  const AroundBin bin{sensor.elevation_min + (8.0 + 0.5) * 0.25 * kDegree};
  const auto told = [&](const std::vector<Eigen::Vector3f>& points) {
    return image_of(points, sensor).observe(bin.at(20.0, 0.0, 0.0));
  };
  const Eigen::Vector3f beside = bin.at(10.0, 1.0, 0.0);
  CHECK(told({beside}) == Observation::kOccluded);  // No beam continues beyond.
  CHECK(told({beside, bin.at(21.3, 0.0, 0.0)}) == Observation::kOccluded);
  CHECK(told({beside, bin.at(21.4, 0.0, 0.0)}) == Observation::kFree);
  CHECK(told({bin.at(21.3, 0.0, 0.0)}) == Observation::kFree);  // The whole window is clear.
  CHECK(told({beside, bin.at(20.0, -1.0, 0.0), bin.at(30.0, 0.0, 0.0)}) == Observation::kAgree);
  // The place is below the horizon. A gap reaches two rows down, and one row up.
  const Eigen::Vector3f beyond = bin.at(30.0, 0.0, 0.0);
  for (const int row : {-2, -1, 0, 1}) {
    CHECK(told({beside, beyond, bin.at(15.0, 0.0, row)}) == Observation::kOccluded);
  }
  CHECK(told({beside, beyond, bin.at(15.0, 0.0, 2.0)}) == Observation::kFree);
  CHECK(told({beside, bin.at(30.0, 0.0, 1.0)}) ==
        Observation::kOccluded);  // Nothing at or below it.
}

TEST_CASE("a gap above the horizon reaches two rows up, and one row down") {
  const SensorModel sensor = sensor_within(15.0);
  const AroundBin bin{5.125 * kDegree};
  const auto told = [&](double row, const Pose& T_world_sensor) {
    return image_of({bin.at(10.0, 1.0, 0.0), bin.at(30.0, 0.0, 0.0), bin.at(15.0, 0.0, row)},
                    sensor, T_world_sensor)
        .observe(bin.at(20.0, 0.0, 0.0));
  };
  const Pose upright = Pose::Identity();
  CHECK(told(-2.0, upright) == Observation::kFree);
  CHECK(told(2.0, upright) == Observation::kOccluded);
  // Up is up in the world: for a sensor that hangs upside down, the same place is below the
  // horizon.
  const Pose hanging(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  CHECK(told(-2.0, hanging) == Observation::kOccluded);
  CHECK(told(2.0, hanging) == Observation::kFree);
}

TEST_CASE("a place on a slope that beams graze is not seen through beside it") {
  // The returns of a slope two rows apart are 18, 22.5 and 30 m away: 1/range falls by 1/90 from
  // each to the next one, by 1/180 in a row. 20.5 m are 0.8 rows before 22.5 m, and 19 m are 1.5.
  const SensorModel sensor = sensor_within(15.0);
  const AroundBin bin{5.125 * kDegree};
  const auto told = [&](double range, const std::vector<Eigen::Vector3f>& points) {
    return image_of(points, sensor).observe(bin.at(range, 0.0, 0.0));
  };
  const Eigen::Vector3f first = bin.at(18.0, 0.0, -2.0), second = bin.at(22.5, 0.0, 0.0),
                        third = bin.at(30.0, 0.0, 2.0);
  CHECK(told(20.5, {first, second, third}) == Observation::kOccluded);
  // Above the slope by more than a row, or with two returns only, it is visible beside the
  // occluder.
  CHECK(told(19.0, {first, second, third}) == Observation::kFree);
  CHECK(told(20.5, {first, second}) == Observation::kFree);
  // The third return may lie before the others: 15 m are 1/90 more than 18 m.
  CHECK(told(20.5, {bin.at(15.0, 0.0, -4.0), first, second}) == Observation::kOccluded);
  // A person before the slope: 1/range falls by five times as much as behind the person.
  CHECK(told(20.5, {bin.at(10.0, 0.0, -2.0), second, third}) == Observation::kFree);
  CHECK(told(20.5, {bin.at(14.0, 0.0, -2.0), second, third}) == Observation::kOccluded);
}

TEST_CASE("few beams see through what they meet and pass, though lower ones end before it") {
  // Beams 2 degrees apart, in the middles of rows of 1 degree, hit a road 1.7 m below: the beams at
  // 5 and 3 degrees hit it 19.5 and 32.5 m away. A hit of the upper beam 26 m away is 0.34 m above
  // the road, and the lower beam is in its window.
  const SensorModel sensor = sensor_within(15.5, 2.0);
  const auto at = [](double range, double elevation) -> Eigen::Vector3f {
    return (range * direction(0.0, elevation * kDegree)).cast<float>();
  };
  const auto told = [&](const Eigen::Vector3f& place, const std::vector<Eigen::Vector3f>& points,
                        const Pose& T_world_sensor = Pose::Identity()) {
    const RangeImage image = image_of(points, sensor, T_world_sensor);
    const Observation observation = image.observe(place);
    CHECK(image.observe(place, SeenThrough::kAtOrBelow) == observation);
    return observation;
  };
  const Eigen::Vector3f road = at(19.5, -5.0);
  CHECK(told(at(26.0, -3.0), {road, at(32.5, -3.0)}) == Observation::kFree);
  // A return is beyond from 26 + 0.25 + 0.005 * 26 + 1 = 27.38 m on.
  CHECK(told(at(26.0, -3.0), {road, at(27.3, -3.0)}) == Observation::kOccluded);
  CHECK(told(at(26.0, -3.0), {road, at(27.5, -3.0)}) == Observation::kFree);
  // The beam is 1.7 m - 30.4 m * sin(3 degrees) = 0.11 m above the road, and 0.09 m at 30.8 m.
  CHECK(told(at(30.4, -3.0), {road, at(32.5, -3.0)}) == Observation::kFree);
  CHECK(told(at(30.8, -3.0), {road, at(32.5, -3.0)}) == Observation::kOccluded);
  // The hit of the lower beam beyond the place is no surface that extends to it. A person in the
  // next column occludes the place.
  const Eigen::Vector3f beside = (10.0 * direction(0.725 * kDegree, -3.0 * kDegree)).cast<float>();
  CHECK(told(at(26.0, -3.0), {beside, at(26.8, -5.0), at(32.5, -3.0)}) == Observation::kFree);
  // The beam may pass 0.02 m above the place: 0.044 degrees at 26 m.
  CHECK(told(at(26.0, -3.04), {road, at(32.5, -3.0)}) == Observation::kFree);
  CHECK(told(at(26.0, -3.05), {road, at(32.5, -3.0)}) == Observation::kOccluded);
  CHECK(told(at(26.0, -2.6), {road, at(32.5, -3.0)}) == Observation::kFree);
  // All returns of the bin must be beyond.
  CHECK(told(at(26.0, -3.0), {road, at(32.5, -3.0), at(22.0, -3.1)}) == Observation::kOccluded);
  // A voxel of 0.2 m is as high as a row 11.46 m away. Nearer ones are met by other beams, too.
  CHECK(told(at(11.4, -3.0), {at(9.0, -5.0), at(32.5, -3.0)}) == Observation::kOccluded);
  CHECK(told(at(11.5, -3.0), {at(9.0, -5.0), at(32.5, -3.0)}) == Observation::kFree);
  // Above the horizon, as the world has it, surfaces are met from below.
  const Pose tilted(Eigen::AngleAxisd(-10.0 * kDegree, Eigen::Vector3d::UnitY()));
  CHECK(told(at(26.0, -3.0), {at(19.5, -1.0), at(32.5, -3.0)}, tilted) == Observation::kOccluded);
}

TEST_CASE("a place above the highest beam is not seen through") {
  // A ceiling 3 m above the sensor, whose highest beam is at 15 degrees: the nearest return is 11.2
  // m ahead, and the ceiling before it is within the window of that beam.
  const SensorModel sensor = sensor_within(15.0, 2.0);
  const auto ceiling = [](double elevation) -> Eigen::Vector3f {
    return (3.0 / std::sin(elevation * kDegree) * direction(0.0, elevation * kDegree))
        .cast<float>();
  };
  const RangeImage image = image_of({ceiling(14.9), ceiling(13.0)}, sensor);
  CHECK(image.observe(ceiling(14.9)) == Observation::kAgree);
  CHECK(image.observe(ceiling(16.5)) == Observation::kUnknown);
  // A lower object is observed as free: the same beam passes it.
  CHECK(image.observe(Eigen::Vector3f(0.6F * ceiling(14.9))) == Observation::kFree);
  // A place near the sensor has a larger window and the same result.
  const Eigen::Vector3f above = (2.2 * direction(0.0, 16.5 * kDegree)).cast<float>();
  CHECK(image.observe(above) == Observation::kUnknown);
  std::vector<ObservedPlace> observed;
  image.observe({above.x(), above.y(), above.z()}, Pose::Identity(), SeenThrough::kInRowOrBelow,
                observed);
  CHECK(observed.empty());
}

TEST_CASE("places are observed alike one by one, all at once, and by every instruction set",
          "[simd]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> angle(-3.2F, 3.2F), slope(-0.4F, 0.3F), range(1.0F, 90.0F);
  const auto somewhere = [&](float steeper) {
    const float a = angle(random);
    return Eigen::Vector3f(
        range(random) *
        Eigen::Vector3f(std::cos(a), std::sin(a), steeper * slope(random)).normalized());
  };
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20000; ++i) points.push_back(somewhere(1.0F));
  std::vector<float> places;
  for (int i = 0; i < 50003; ++i) {
    const Eigen::Vector3f place = somewhere(1.5F);
    places.insert(places.end(), place.data(), place.data() + 3);
  }
  const Parameters parameters;
  const SensorModel sensor = GENERATE(Scanner{}.model(), sensor_with_beams());
  std::array<int, 4> found{};
  for (const auto& [set, seen] : sets_and_rules()) {
    const InstructionSetScope scope(set);
    const RangeImage image = image_of(points, sensor);
    std::vector<ObservedPlace> observed;
    image.observe(places, Pose::Identity(), seen, observed);
    auto next = observed.begin();
    for (std::uint32_t k = 0; k < places.size() / 3; ++k) {
      const Eigen::Vector3f place = Eigen::Map<const Eigen::Vector3f>(places.data() + 3 * k);
      const bool near = place.norm() >= static_cast<float>(parameters.evidence_range_min) &&
                        place.norm() <= static_cast<float>(parameters.evidence_range_max);
      const Observation wanted = image.observe(place, seen);
      ++found[static_cast<std::size_t>(wanted)];
      const bool told = next != observed.end() && next->place == k;
      REQUIRE(told == (near && (wanted == Observation::kAgree || wanted == Observation::kFree)));
      if (!told) continue;
      REQUIRE(next->observation == wanted);
      ++next;
    }
    CHECK(next == observed.end());
  }
  for (const int count : found) CHECK(count > 100);
}

TEST_CASE("places near the sensor, with large windows, are observed as bin by bin") {
  // A room with a pillar, a gap in the wall and no returns from above: some whole windows support,
  // occlude, are free or are empty, and others are mixed.
  std::mt19937 random(9);
  std::uniform_real_distribution<float> angle(-3.2F, 3.2F), slope(-0.45F, 0.15F), any(0.0F, 1.0F);
  const auto somewhere = [&](float steeper, const auto& range_at) {
    const float a = angle(random), range = range_at(a);
    return Eigen::Vector3f(
        range * Eigen::Vector3f(std::cos(a), std::sin(a), steeper * slope(random)).normalized());
  };
  const auto wall = [](float a) {
    if (a > 3.0F || a < -3.0F) return 2.5F;  // The pillar, on both sides of the first column.
    return a > 0.5F && a < 0.9F ? 30.0F : 6.0F + 2.0F * std::sin(3.0F * a);
  };
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 40000; ++i) points.push_back(somewhere(1.0F, wall));
  std::vector<float> places;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3f place =
        somewhere(1.5F, [&](float a) { return std::max(2.1F, (0.5F + any(random)) * wall(a)); });
    places.insert(places.end(), place.data(), place.data() + 3);
  }
  const SeenThrough seen = GENERATE(SeenThrough::kInRowOrBelow, SeenThrough::kAtOrBelow);
  const RangeImage image = image_of(points, GENERATE(Scanner{}.model(), sensor_with_beams()));
  std::vector<ObservedPlace> observed;
  image.observe(places, Pose::Identity(), seen, observed);
  std::vector<Observation> told(places.size() / 3, Observation::kOccluded);
  for (const ObservedPlace& place : observed) told[place.place] = place.observation;
  std::array<int, 4> found{};
  for (std::size_t k = 0; k < told.size(); ++k) {
    Observation wanted = image.observe(
        Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(places.data() + 3 * k)), seen);
    ++found[static_cast<std::size_t>(wanted)];
    if (wanted == Observation::kUnknown) wanted = Observation::kOccluded;
    REQUIRE(told[k] == wanted);
  }
  for (const int count : found) CHECK(count > 100);
}

TEST_CASE("seen from above, the ground before a foot says nothing of the foot") {
  // The sensor is 1.5 m above the ground, and has rows of a quarter of a degree. The middle of a
  // voxel is 0.15 m above the ground and 2.8 m away. Its window, half a voxel up and down, takes in
  // ground that is as far away.
  const double height = 1.5, above = 0.15, range = 2.8;
  const double elevation = -std::asin((height - above) / range);
  const Eigen::Vector3f foot = (range * direction(0.0, elevation)).cast<float>();
  SensorModel sensor = sensor_with_beams();
  sensor.elevation_min = -60.0 * kDegree;
  std::vector<Eigen::Vector3f> ground;
  for (double e = -55.0; e < -5.0; e += 0.25) {
    for (double a = -5.0; a < 5.0; a += 0.25) {
      const double length = height / std::sin(-e * kDegree);
      ground.push_back((length * direction(a * kDegree, e * kDegree)).cast<float>());
    }
  }
  const auto seen = [&](const std::vector<Eigen::Vector3f>& more,
                        SeenThrough rule = SeenThrough::kInRowOrBelow,
                        const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
    std::vector<Eigen::Vector3f> points = ground;
    points.insert(points.end(), more.begin(), more.end());
    for (Eigen::Vector3f& point : points) point = turn.inverse().cast<float>() * point;
    const RangeImage image = image_of(points, sensor, Pose(turn));
    return image.observe(turn.inverse().cast<float>() * foot, rule);
  };
  CHECK(seen({}) == Observation::kFree);
  // For ground, the whole window is still used.
  CHECK(seen({}, SeenThrough::kAtOrBelow) == Observation::kAgree);
  // The foot itself, 4 cm higher or lower, and 10 cm farther or nearer.
  for (const double up : {-0.04, 0.04}) {
    for (const double along : {-0.1, 0.1}) {
      const Eigen::Vector3f point =
          foot + Eigen::Vector3f(static_cast<float>(along), 0.0F, static_cast<float>(up));
      CHECK(seen({point}) == Observation::kAgree);
    }
  }
  // A person half a metre before it occludes it, at any height of the hit.
  const Eigen::Vector3f before = (2.3 * direction(0.0, elevation - 1.5 * kDegree)).cast<float>();
  CHECK(seen({before}) == Observation::kOccluded);
  // If the ground is hit, beams that pass lower or higher are no free observations of it, though
  // they continue.
  const auto passing = [&](double up) {
    const Eigen::Vector3f met = (2.85 * direction(0.0, elevation - 0.03)).cast<float>();
    const Eigen::Vector3f beyond = (6.0 * direction(0.0, elevation + up / range)).cast<float>();
    return image_of({met, beyond}, sensor).observe(foot);
  };
  CHECK(passing(-0.03) == Observation::kFree);
  CHECK(passing(-0.09) == Observation::kUnknown);
  CHECK(passing(0.09) == Observation::kUnknown);
  // Height is that above the ground, however the sensor is turned.
  const Eigen::Quaterniond down(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
  CHECK(seen({}, SeenThrough::kInRowOrBelow, down) == Observation::kFree);
  CHECK(seen({foot}, SeenThrough::kInRowOrBelow, down) == Observation::kAgree);
}

TEST_CASE("a sensor has even beams if they are known, or its steps differ") {
  SensorModel sensor = Scanner{}.model();  // The same step both ways, as of a rosette.
  CHECK_FALSE(has_even_beams(sensor));
  sensor.beams = 41;
  CHECK(has_even_beams(sensor));
  sensor.basis = "41 beams";
  CHECK(has_even_beams(sensor));
  sensor.beams = 0;
  sensor.azimuth_step *= 0.5;
  CHECK_FALSE(has_even_beams(sensor));  // It was estimated without beams.
  for (const std::string& name : sensor_model_names()) {
    CHECK(has_even_beams(sensor_model_named(name)));
  }
  CHECK_FALSE(has_even_beams(SensorModel{}));  // A model without values.
}

TEST_CASE("the bins of places are those of atan2 and asin, but for places on their borders",
          "[simd]") {
  std::mt19937 random(4);
  std::normal_distribution<float> place(0.0F, 20.0F);
  const float columns = 1440.0F, full = 2.0F * std::numbers::pi_v<float>;
  const kernels::SightGrid grid{columns / full, 300.0F, -0.5F, 1440};
  const Pose turned(Eigen::Translation3d(3.0, -2.0, 1.0) *
                    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rotation = turned.linear().cast<float>();
  std::vector<Eigen::Vector3f> places(5001);
  for (Eigen::Vector3f& at : places) at = {place(random), place(random), 0.3F * place(random)};
  kernels::SightPlaces job{places.front().data(), places.size(), {}, {3.0F, -2.0F, 1.0F}};
  std::copy_n(rotation.data(), 9, job.rotation.begin());
  for (const InstructionSet set : supported_instruction_sets()) {
    std::vector<float> range(places.size() + kernels::kMostLanes);
    std::vector<std::int32_t> column(range.size()), row(range.size());
    const InstructionSetScope scope(set);
    kernels::best_sight_kernels().locate(grid, job, {range.data(), column.data(), row.data()});
    int on_borders = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Eigen::Vector3d at = turned * places[k].cast<double>();
      const double r = at.norm();
      const double x =
          (std::atan2(at.y(), at.x()) + std::numbers::pi) * static_cast<double>(columns / full);
      const double y = (std::asin(at.z() / r) + 0.5) * 300.0;
      REQUIRE(range[k] == Approx(r).epsilon(1e-6));
      // 1e-3 of a bin is 3e-6 radians or more.
      const auto on_border = [](double bin) { return std::abs(bin - std::round(bin)) < 1e-3; };
      if (on_border(x) || on_border(y)) {
        ++on_borders;
        continue;
      }
      REQUIRE(column[k] == static_cast<int>(x));
      REQUIRE(row[k] == static_cast<int>(std::floor(y)));
    }
    CHECK(on_borders < 50);
  }
}

TEST_CASE("a place is looked up where the formulas of azimuth and elevation say") {
  // One return a direction; the same direction agrees, others as far apart as two windows do not.
  for (int degrees = -180; degrees <= 180; degrees += 7) {
    for (const int up : {-9, -3, 0, 8}) {
      const double a = degrees * kDegree, e = up * kDegree;
      const RangeImage image = image_of({(20.0 * direction(a, e)).cast<float>()});
      CHECK(image.observe((20.1 * direction(a, e)).cast<float>()) == Observation::kAgree);
      const Eigen::Vector3d aside = 20.1 * direction(a + 8.0 * kDegree, e);
      CHECK(image.observe(aside.cast<float>()) == Observation::kUnknown);
    }
  }
}

}  // namespace raymoval::raymoval_plus_test
