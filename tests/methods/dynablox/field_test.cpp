// SPDX-License-Identifier: MIT
// The distance field and the free space, on walls and voxels that are put where they are wanted.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "methods/dynablox/field.h"
#include "tests/methods/toy_world.h"

namespace raymoval::dynablox_test {
using namespace raymoval::dynablox_method;

namespace {

/// What voxels at (x, 0, 0) hold after some scans.
class Field {
 public:
  Field(const Parameters& parameters, const SensorModel& sensor)
      : integrator_(parameters, sensor), size_(parameters.voxel_size) {}

  void see(const Scan& scan) { integrator_.integrate(scan, RunContext{}, map_, touched_); }
  [[nodiscard]] float distance(int x) const { return layer(x).distance[column(x)]; }
  [[nodiscard]] float weight(int x) const { return layer(x).weight[column(x)]; }
  /// How far the centre of the voxel is from the origin, metres.
  [[nodiscard]] double range(int x) const {
    return std::hypot((x + 0.5) * size_, 0.5 * size_, 0.5 * size_);
  }
  [[nodiscard]] const std::vector<Block*>& touched() const { return touched_; }

 private:
  static std::size_t column(int x) { return static_cast<std::size_t>(x & (kSide - 1)); }
  [[nodiscard]] const Layer& layer(int x) const {
    const Block* block = map_.find(block_of({x, 0, 0}));
    REQUIRE(block != nullptr);
    REQUIRE(block->layers[0] != nullptr);
    return *block->layers[0];
  }

  Integrator integrator_;
  double size_;
  BlockMap map_;
  std::vector<Block*> touched_;
};

/// A return in each direction ahead, 0.2 by 1 degrees apart.
/// @param range_at metres at an azimuth in degrees; 0 where there is no return
Scan wall(const std::function<double(double)>& range_at) {
  Scan scan;
  for (int azimuth = -60; azimuth < 60; ++azimuth) {
    for (int elevation = -16; elevation <= 16; ++elevation) {
      const double degrees = (azimuth + 0.5) * 0.2, range = range_at(degrees);
      if (range == 0.0) continue;
      const Eigen::Vector3d u = toy::direction(degrees * kDegree, elevation * kDegree);
      scan.points.emplace_back((range * u).cast<float>());
    }
  }
  return scan;
}
Scan wall(double range) {
  return wall([range](double) { return range; });
}

}  // namespace

TEST_CASE("dynablox: a voxel holds the mean of its distances to the surface") {
  Parameters parameters;
  parameters.voxel_size = 0.25;
  Field field(parameters, sensor_model_named("vlp16"));
  field.see(wall(3.0));
  CHECK(field.distance(4) == 0.4F);  // Far in front: cut off.
  CHECK(field.distance(11) == Approx(3.0 - field.range(11)).margin(1e-4));
  CHECK(field.distance(12) == Approx(3.0 - field.range(12)).margin(1e-4));
  CHECK(field.weight(14) == 0.0F);  // 0.63 m behind the wall.
  const float weight = field.weight(12);
  field.see(wall(3.2));  // Weighs as much, since it lies as many rays ahead.
  CHECK(field.distance(12) == Approx(3.1 - field.range(12)).margin(1e-4));
  CHECK(field.weight(12) == 2.0F * weight);
}

TEST_CASE("dynablox: a scan weighs as many rays as go through a voxel") {
  // 1800 columns around and 16 rows in 30 degrees: 286.5 and 30.56 a radian, of which a voxel of
  // 0.25 m takes 71.62 and 7.639 at one metre, 547.1 pixels.
  Parameters parameters;
  parameters.voxel_size = 0.25;
  Field field(parameters, sensor_model_named("vlp16"));
  const double at_a_metre = 1800 / kTurn * 16 / (30 * kDegree) * 0.0625;
  CHECK(at_a_metre == Approx(547.1).margin(0.1));
  field.see(wall(3.0));
  CHECK(field.weight(4) == Approx(at_a_metre / std::pow(field.range(4), 2)));
  CHECK(field.weight(12) == Approx(at_a_metre / std::pow(field.range(12), 2)));
  // 0.38 m behind the surface: 0.02 of 0.15 m are left till the weight is 0.
  const double left = (0.4 + 3.0 - field.range(13)) / (0.4 - 0.25);
  CHECK(left == Approx(0.13).margin(0.01));
  CHECK(field.weight(13) == Approx(left * at_a_metre / std::pow(field.range(13), 2)).epsilon(1e-2));
  // Never more rays than at one metre, and never more in total than the limit.
  CHECK(field.weight(2) == Approx(at_a_metre).epsilon(1e-5));
  field.see(wall(3.0));
  CHECK(field.weight(2) == 1000.0F);
}

TEST_CASE("dynablox: between pixels is their mean, unless one is much nearer") {
  // Pixels of one degree. The voxel is seen at 1.17 degrees, between the middle of a pixel with the
  // wall at 5 m and one, at two thirds of the way, with a wall further back.
  SensorModel sensor;
  sensor.azimuth_step = kDegree;
  const int x = 24;
  const auto seen_with = [&](double further) {
    Field field(Parameters{}, sensor);
    field.see(wall([further](double azimuth) { return azimuth < 1.0 ? 5.0 : further; }));
    return field.distance(x) + field.range(x);
  };
  const double share = std::atan2(0.1, 4.9) / kDegree - 0.5;
  CHECK(share == Approx(0.669).margin(1e-3));
  CHECK(seen_with(5.15) == Approx(5.0 + 0.15 * share).margin(1e-4));
  // 0.29 and 0.31 m further back, of which two thirds are less and more than half the truncation.
  CHECK(seen_with(5.29) == Approx(5.0 + 0.29 * share).margin(1e-4));
  CHECK(seen_with(5.31) == Approx(5.0).margin(1e-4));
  // One return alone determines the value.
  CHECK(seen_with(0.0) == Approx(5.0).margin(1e-4));
}

TEST_CASE("dynablox: a far return clears blocks that nearer ones touch") {
  // Nothing within 20 m but one return 9 m ahead.
  Scan scan = wall(30.0);
  scan.points.emplace_back(9.0F, 0.05F, 0.05F);
  Field field(Parameters{}, sensor_model_named("vlp16"));
  field.see(scan);
  CHECK(field.touched().size() == 3);  // Blocks of 3.2 m: 0 to 9.4 m.
  CHECK(field.weight(10) > 0.0F);
}

TEST_CASE("dynablox: what was occupied for long is reset where it is, not where it is free") {
  // Ever free: two beside each other and a third. The first was occupied for 150 scans, long ago;
  // the scan has points in the second, or in the first.
  const VoxelIndex first(4, 5, 6), second(5, 5, 6), third(9, 5, 6);
  for (const bool is_there : {false, true}) {
    BlockMap map;
    Block& block = map.find_or_make({0, 0, 0}, VoxelIndex(0, 0, 0));
    for (std::unique_ptr<Layer>& layer : block.layers) {
      layer = std::make_unique<Layer>();
      layer->distance.fill(0.4F);
      layer->weight.fill(1.0F);
      layer->last_occupied.fill(is_there ? 299 : -1);
    }
    for (const VoxelIndex& voxel : {first, second, third}) insert(voxel, block.ever_free);
    block.layers[6]->occupied_scans[5 * kSide + 4] = 150;
    SparseBlocks<BlockBits> hits;
    insert(is_there ? first : second, hits.find_or_make({0, 0, 0}));
    FreeSpace(Parameters{}).update({&block}, hits, 300, RunContext{}, map);
    CHECK(contains(block.ever_free, first) == !is_there);
    CHECK(contains(block.ever_free, second) == !is_there);
    CHECK(contains(block.ever_free, third));
  }
}

}  // namespace raymoval::dynablox_test
