// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// Gives query points the label of their exact nearest neighbour, however far away that is.
class NearestLabels {
 public:
  /// Keeps `cloud`, which needs at least one point.
  explicit NearestLabels(LabelledCloud cloud);
  ~NearestLabels();
  NearestLabels(const NearestLabels&) = delete;
  NearestLabels& operator=(const NearestLabels&) = delete;

  /// The label of the nearest point of each query point. Among points within `kLabelTieMargin` of
  /// the nearest one, the point with the lowest index gives the label. The number of threads does
  /// not change the answer.
  [[nodiscard]] std::vector<std::uint32_t> labels_of(const std::vector<Eigen::Vector3d>& queries,
                                                     int threads) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace raymoval
