// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// Hands on labels by exact nearest neighbour, however far away it is.
class NearestLabels {
 public:
  /// Keeps `cloud`, which needs at least one point.
  explicit NearestLabels(LabelledCloud cloud);
  ~NearestLabels();
  NearestLabels(const NearestLabels&) = delete;
  NearestLabels& operator=(const NearestLabels&) = delete;

  /// For each query point the label of its nearest point; among points within `kLabelTieMargin` of
  /// the nearest, that of the lowest index. The number of threads does not change the answer.
  [[nodiscard]] std::vector<std::uint32_t> labels_of(const std::vector<Eigen::Vector3d>& queries,
                                                     int threads) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace raymoval
