// SPDX-License-Identifier: MIT
#include "eval/points/nearest_labels.h"

#include <nanoflann.hpp>
#include <utility>

#include "core/parallel.h"
#include "eval/points/label_vote.h"

namespace raymoval {
namespace {

/// A cloud as nanoflann wants to see it.
struct CloudView {
  const LabelledCloud& cloud;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return cloud.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t point, std::size_t axis) const {
    return cloud.points[point][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

/// Collects what a search meets; the search prunes whatever lies beyond `worstDist`.
struct VoteCollector {
  using DistanceType = double;
  LabelVote& vote;
  [[nodiscard]] std::size_t size() const { return 0; }
  [[nodiscard]] bool full() const { return true; }
  bool addPoint(double squared_distance, std::uint32_t point) const {
    vote.offer(squared_distance, point);
    return true;
  }
  [[nodiscard]] double worstDist() const { return 1.000001 * vote.reach() * vote.reach(); }
  void sort() const {}  // nanoflann 1.5 and later calls it.
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CloudView>,
                                                  CloudView, 3, std::uint32_t>;

}  // namespace

struct NearestLabels::Tree {
  explicit Tree(LabelledCloud points) : cloud(std::move(points)), view{cloud}, index(3, view) {}
  LabelledCloud cloud;
  CloudView view;
  Index index;
};

NearestLabels::NearestLabels(LabelledCloud cloud)
    : tree_(std::make_unique<Tree>(std::move(cloud))) {}
NearestLabels::~NearestLabels() = default;

std::vector<std::uint32_t> NearestLabels::labels_of(const std::vector<Eigen::Vector3d>& queries,
                                                    int threads) const {
  std::vector<std::uint32_t> labels(queries.size());
  parallel_chunks(threads, queries.size(), 4096, [&](std::size_t begin, std::size_t end) {
    LabelVote vote;
    VoteCollector collector{vote};
    for (std::size_t i = begin; i < end; ++i) {
      vote.clear();
      tree_->index.findNeighbors(collector, queries[i].data(), {});
      labels[i] = tree_->cloud.labels[vote.decide([](std::uint32_t) { return false; }).point];
    }
  });
  return labels;
}

}  // namespace raymoval
