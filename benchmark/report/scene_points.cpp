// SPDX-License-Identifier: MIT
#include "benchmark/report/scene_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/morton.h"

namespace raymoval {
namespace {

/// The Morton code of a point: the bits of its coordinates in turn, z on top.
using Morton = std::array<std::uint64_t, 2>;

Morton morton_of(const ShownPoint& point) {
  Morton code{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto biased = static_cast<std::uint64_t>(std::int64_t{point.step[axis]} + (1LL << 31));
    code[0] |= spread_bits(biased >> 21) << axis;
    code[1] |= spread_bits(biased) << axis;
  }
  return code;
}

}  // namespace

std::array<std::int32_t, 3> steps_of(const Eigen::Vector3d& world) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max() - kStepsPerVoxel;
  std::array<std::int32_t, 3> steps{};
  for (int axis = 0; axis < 3; ++axis) {
    const double place = world[axis] * (1.0 / kPageVoxel);
    const double voxel = std::floor(place);
    const double inside = world[axis] / kPageVoxel - voxel;
    const double step =
        std::clamp(std::floor(inside * kStepsPerVoxel), 0.0, double{kStepsPerVoxel - 1});
    const double steps_from_zero = voxel * kStepsPerVoxel + step;
    if (!(std::abs(steps_from_zero) <= kMost)) {
      throw_voxel_out_of_range(world.x(), world.y(), world.z(), kPageVoxel);
    }
    steps[axis] = static_cast<std::int32_t>(steps_from_zero);
  }
  return steps;
}

void gather_points(const ReportPoints& first, const ReportPoints& second, Scene& scene) {
  const std::size_t count = first.size() + second.size();
  const auto set_of = [&](std::size_t i) -> std::pair<const ReportPoints&, std::size_t> {
    if (i < first.size()) return {first, i};
    return {second, i - first.size()};
  };
  std::vector<Morton> codes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [set, place] = set_of(i);
    codes[i] = morton_of(set.points()[place]);
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
  });
  scene.points.reserve(count);
  scene.verdicts.assign(scene.cells.size(), std::vector<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto [set, place] = set_of(order[i]);
    scene.points.push_back(set.points()[place]);
    const std::span<const std::uint8_t> verdict = set.verdict(place);
    for (std::size_t cell = 0; cell < verdict.size(); ++cell) {
      scene.verdicts[cell][i] = verdict[cell];
    }
  }
}

}  // namespace raymoval
