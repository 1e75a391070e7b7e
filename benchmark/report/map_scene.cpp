// SPDX-License-Identifier: MIT
#include "benchmark/report/map_scene.h"

#include <array>

#include "benchmark/report/scene_points.h"

namespace raymoval {
namespace {

/// The share of the points that may be removed ones.
constexpr double kRemovedShare = 0.4;

/// Ids of SemanticKITTI for what stands and what moves.
constexpr std::uint16_t kKeptId = 9, kRemovedId = 251;

}  // namespace

MapSceneBuilder::MapSceneBuilder(const std::string& sequence, const std::string& method,
                                 const Pose& T_upright_world, std::size_t limit)
    : limit_(limit),
      removed_(static_cast<std::size_t>(kRemovedShare * static_cast<double>(limit)), 1,
               kStepsPerVoxel),
      kept_(limit, 1, kStepsPerVoxel) {
  scene_.sequence = sequence;
  scene_.T_upright_world = T_upright_world;
  scene_.is_unlabelled = true;
  scene_.cells.push_back({method, false, {}, {}, {}});
  scene_.counts.resize(1);
  scene_.labels = {{kKeptId, "kept", LabelClass::kStatic},
                   {kRemovedId, "removed", LabelClass::kMoving}};
}

void MapSceneBuilder::add_scan(const std::string& name, const Eigen::Vector3d& sensor) {
  scene_.scans.push_back(name);
  scene_.trajectory.push_back(scene_.T_upright_world * sensor);
}

void MapSceneBuilder::add_point(const Eigen::Vector3d& world, bool removed) {
  ++scene_.points_in_range;
  ++(removed ? scene_.counts[0].true_positive : scene_.counts[0].kept_static);
  const auto scan = static_cast<std::uint32_t>(scene_.scans.size() - 1);
  const std::array<std::uint8_t, 1> verdict = {static_cast<std::uint8_t>(removed ? 1 : 0)};
  const ShownPoint shown{steps_of(scene_.T_upright_world * world), scan,
                         removed ? kRemovedId : kKeptId};
  if (removed) {
    removed_.add(shown, scan + 1, verdict);
  } else {
    kept_.add(shown, 0, verdict);
  }
}

Scene MapSceneBuilder::finish() {
  kept_.reduce(limit_ - removed_.size());
  scene_.error_cell = removed_.cell();
  scene_.other_cell = kept_.cell();
  gather_points(removed_, kept_, scene_);
  return std::move(scene_);
}

}  // namespace raymoval
