// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "benchmark/report/scene.h"
#include "core/scan/scan.h"

namespace raymoval {

/// Chooses the points of a cleaned map that a page shows, scan by scan: what was kept and what was
/// removed, without labels. At most `limit` points are held. One is shown in each cell of
/// `kPageVoxel`, or of larger cells if `limit` asks for it; removed points have up to four tenths
/// of the room, and one in each cell and scan.
class MapSceneBuilder {
 public:
  /// @param method the name that the page gives to what was removed
  /// @param T_upright_world the turn that brings up to z
  MapSceneBuilder(const std::string& sequence, const std::string& method,
                  const Pose& T_upright_world, std::size_t limit);

  /// To be called for each scan, with points or without.
  void add_scan(const std::string& name, const Eigen::Vector3d& sensor);
  /// Adds a point of the scan that was added last.
  /// @param world in the frame of the scans, metres
  void add_point(const Eigen::Vector3d& world, bool removed);
  Scene finish();

 private:
  std::size_t limit_;
  ReportPoints removed_, kept_;
  Scene scene_;
};

}  // namespace raymoval
