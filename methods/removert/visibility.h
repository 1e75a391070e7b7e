// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "methods/common/workspaces.h"
#include "methods/removert/map_points.h"
#include "methods/removert/scan_image.h"

namespace raymoval::removert_method {

/// Compares a frozen map with scans, one range image each. The flags do not depend on the order of
/// the scans or the number of threads.
///
/// Most map points are excluded by bounds on blocks and in single precision. The others are decided
/// in double precision, so that the result equals that of projecting every map point.
class VisibilityPass {
 public:
  VisibilityPass(const MapPoints& map, const Parameters& parameters, Candidates candidates);

  /// Flags the map points that one scan sees through. Thread-safe.
  /// @param image made with the candidates of this pass
  void show(const ScanImage& image, const Pose& T_image_world);

  /// 1 for each map point that was nearest in its pixel and dynamic in any scan.
  [[nodiscard]] const Mask& flagged() const { return flagged_; }

 private:
  struct Nearest {
    double range;
    std::size_t point;
  };
  static constexpr Nearest kEmpty{std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<std::size_t>::max()};
  /// Range image of the map (I_M), only for pixels with a map point.
  struct Image {
    std::vector<Nearest> pixels;
    std::vector<int> touched;
  };
  struct View;

  [[nodiscard]] std::vector<std::size_t> order_of_groups(const Pose& T_image_world) const;
  void look_at_block(const View& view, const Block& block, float limit, Image& image) const;
  static void take_if_nearest(const View& view, const Eigen::Vector3d& point, std::size_t id,
                              Image& image);
  void flag(const ScanImage& scan, Image& image);

  const MapPoints& map_;
  const Parameters& parameters_;
  Candidates candidates_;
  Mask flagged_;
  Workspaces<Image> images_;
};

}  // namespace raymoval::removert_method
