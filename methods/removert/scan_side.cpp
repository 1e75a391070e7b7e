// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nanoflann.hpp>
#include <vector>

#include "methods/removert/answer.h"

namespace raymoval::removert_method {
namespace {

/// Points in the shape nanoflann reads.
struct Cloud {
  std::vector<Eigen::Vector3f> points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class Tree {
 public:
  explicit Tree(std::vector<Eigen::Vector3f> points)
      : cloud_{std::move(points)},
        index_(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {
    index_.buildIndex();
  }
  /// Mean square distance to the `k` nearest points, or to as many as there are; nothing near if
  /// there are none.
  [[nodiscard]] double mean_square(const Eigen::Vector3f& point, int k) const {
    if (cloud_.points.empty()) return std::numeric_limits<double>::infinity();
    const auto wanted = std::min(static_cast<std::size_t>(k), cloud_.points.size());
    std::vector<std::uint32_t> found(wanted);
    std::vector<float> squares(wanted);
    index_.knnSearch(point.data(), wanted, found.data(), squares.data());
    double sum = 0.0;
    for (const float square : squares) sum += static_cast<double>(square);
    return sum / static_cast<double>(wanted);
  }

 private:
  using Index =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3>;
  Cloud cloud_;
  Index index_;
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
  NeighbourAnswer(const MapPoints& kept, const RemovertParameters& parameters)
      : neighbours_(parameters.scan_side_neighbours),
        threshold_(parameters.scan_side_threshold),
        origin_(kept.blocks.empty() ? Eigen::Vector3d::Zero() : kept.blocks.front().centre),
        map_(relative(kept, origin_)) {}

  [[nodiscard]] Mask of(const Scan& scan, std::uint64_t) const override {
    const Tree own(scan.points);
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
  Tree map_;
};

}  // namespace

std::unique_ptr<Answer> answer_by_neighbours(const MapPoints& kept,
                                             const RemovertParameters& parameters) {
  return std::make_unique<NeighbourAnswer>(kept, parameters);
}

}  // namespace raymoval::removert_method
