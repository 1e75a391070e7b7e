// SPDX-License-Identifier: MIT
#include "eval/points/cloud_masks.h"

#include "eval/points/nearest_points.h"
#include "eval/points/scan_loops.h"

namespace raymoval {

MaskStore masks_of_cloud(const EvaluationInput& input, const std::vector<Eigen::Vector3f>& cloud,
                         double distance) {
  const NearbyPoints near(cloud, distance);
  MaskStore masks(input.scans->size());
  for_each_scan(input, "points of the cloud", [&](std::size_t i) {
    const Scan scan = input.scans->load(i);
    Mask mask(scan.size(), 0);
    for (std::size_t p = 0; p < mask.size(); ++p) {
      mask[p] = near.has_near(scan.T_world_sensor * scan.points[p].cast<double>()) ? 0 : 1;
    }
    masks.set(i, mask);
  });
  return masks;
}

const MaskStore& CloudEstimate::masks(const EvaluationInput& input, double distance) const {
  if (distance_ != distance) {
    masks_ = masks_of_cloud(input, points_, distance);
    distance_ = distance;
  }
  return masks_;
}

}  // namespace raymoval
