// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "methods/common/workspaces.h"
#include "methods/removert/map_points.h"
#include "methods/removert/scan_image.h"

namespace raymoval::removert_method {

/// Compares a frozen map with scans, one range image each. The votes are the same in whatever order
/// and from however many threads scans are shown.
///
/// Map points are sorted out by bounds on blocks of them and in single precision; what is left is
/// decided in double precision, so that the answer is that of projecting every map point.
class VisibilityPass {
 public:
  VisibilityPass(const MapPoints& map, const Parameters& parameters, Candidates candidates);

  /// Votes of one scan. Thread-safe.
  /// @param image made with the candidates of this pass
  void show(const ScanImage& image, const Pose& T_image_world);

  /// Of each map point: scans in which it is the nearest in its pixel and dynamic (n_DM).
  [[nodiscard]] const std::vector<std::uint32_t>& dynamic_votes() const { return votes_; }

 private:
  struct Nearest {
    double range;
    std::size_t point;
  };
  static constexpr Nearest kEmpty{std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<std::size_t>::max()};
  /// Range image of the map (I_M), only where something was found.
  struct Image {
    std::vector<Nearest> pixels;
    std::vector<int> touched;
  };
  struct View;

  [[nodiscard]] std::vector<std::size_t> order_of_groups(const Pose& T_image_world) const;
  void look_at_block(const View& view, const Block& block, float limit, Image& image) const;
  static void take_if_nearest(const View& view, const Eigen::Vector3d& point, std::size_t id,
                              Image& image);
  void vote(const ScanImage& scan, Image& image);

  const MapPoints& map_;
  const Parameters& parameters_;
  Candidates candidates_;
  std::vector<std::uint32_t> votes_;
  Workspaces<Image> images_;
};

}  // namespace raymoval::removert_method
