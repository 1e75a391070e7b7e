// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <vector>

#include "methods/common/point_tree.h"
#include "methods/removert/answer.h"

namespace raymoval::removert_method {
namespace {

/// Points with a tree to find neighbours among them.
class Neighbours {
 public:
  explicit Neighbours(std::vector<Eigen::Vector3f> points)
      : points_(std::move(points)), tree_(points_) {}

  /// The mean square distance to the `k` nearest points, or to as many as there are; infinite if
  /// there are none.
  [[nodiscard]] double mean_square(const Eigen::Vector3f& point, int k) const {
    if (points_.empty()) return std::numeric_limits<double>::infinity();
    const auto wanted = std::min(static_cast<std::size_t>(k), points_.size());
    std::vector<std::uint32_t> found(wanted);
    std::vector<float> squares(wanted);
    tree_.find_nearest(point, found, squares);
    double sum = 0.0;
    for (const float square : squares) sum += static_cast<double>(square);
    return sum / static_cast<double>(wanted);
  }

 private:
  std::vector<Eigen::Vector3f> points_;
  PointTree<Eigen::Vector3f> tree_;
};

/// World points relative to `origin`, so that single precision is enough far from the world's.
std::vector<Eigen::Vector3f> relative(const MapPoints& map, const Eigen::Vector3d& origin) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(map.size());
  for (const Block& block : map.blocks) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      points.emplace_back((map.position(block, i) - origin).cast<float>());
    }
  }
  return points;
}

class NeighbourAnswer : public Answer {
 public:
  NeighbourAnswer(const MapPoints& kept, const Parameters& parameters)
      : neighbours_(parameters.scan_side_neighbours),
        threshold_(parameters.scan_side_threshold),
        origin_(kept.blocks.empty() ? Eigen::Vector3d::Zero() : kept.blocks.front().centre),
        map_(relative(kept, origin_)) {}

  [[nodiscard]] Mask of(const Scan& scan, std::uint64_t) const override {
    const Neighbours own(scan.points);
    Mask mask(scan.size());
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const Eigen::Vector3d world = scan.T_world_sensor * scan.points[i].cast<double>();
      const double in_scan = own.mean_square(scan.points[i], neighbours_);
      const double in_map = map_.mean_square((world - origin_).cast<float>(), neighbours_);
      mask[i] = std::abs(in_scan - in_map) < threshold_ ? 0 : 1;
    }
    return mask;
  }

 private:
  int neighbours_;
  double threshold_;
  Eigen::Vector3d origin_;
  Neighbours map_;
};

}  // namespace

std::unique_ptr<Answer> answer_by_neighbours(const MapPoints& kept, const Parameters& parameters) {
  return std::make_unique<NeighbourAnswer>(kept, parameters);
}

}  // namespace raymoval::removert_method
