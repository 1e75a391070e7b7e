// SPDX-License-Identifier: MIT
// How far apart voxels of the truth and of the estimate may lie: half a diagonal, strictly.
#include <catch2/catch.hpp>

#include "eval/erasor/matching.h"

namespace raymoval::erasor {
namespace {

/// One voxel with the centroid `point` of a lattice of 0.25 m.
ListedVoxels voxel_at(const Eigen::Vector3d& point) {
  LabelledVoxels voxels;
  voxels.keys = {voxel_key(voxel_index(point, 4.0))};
  voxels.cloud.points = {point};
  voxels.cloud.labels = {40};
  return {voxels, LabelClasses(LabelRule{})};
}

bool match(const Eigen::Vector3d& offset) {
  const Eigen::Vector3d at(1.0625, -2.0, 0.125);
  Options options;
  options.voxel_size = 0.25;
  const auto partners = partner_kinds(voxel_at(at), voxel_at(at + offset), options, 1);
  return partners == std::vector<VoxelKind>{VoxelKind::kStatic};
}

}  // namespace

TEST_CASE("voxels match nearer than half a diagonal in any direction", "[erasor]") {
  // The bound is 3/64 m^2. All of these are exact: 1/8 along each axis is 3/64.
  CHECK_FALSE(match({0.125, 0.125, 0.125}));
  CHECK_FALSE(match({-0.125, 0.125, -0.125}));
  CHECK(match({0.125, 0.125, 0.125 - 0x1p-40}));
  // Along one axis: 7/32 squared is 49/1024, just above 48/1024; 6.9/32 is below it.
  CHECK_FALSE(match({0.21875, 0, 0}));
  CHECK(match({-0.215625, 0, 0}));
  CHECK(match({0, 0, 0.1875}));
}

}  // namespace raymoval::erasor
