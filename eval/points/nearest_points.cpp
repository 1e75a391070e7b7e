// SPDX-License-Identifier: MIT
#include "eval/points/nearest_points.h"

#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/point_tree.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Stops the search at the first point in reach. The search prunes a little beyond it, so that
/// rounding loses none.
struct FirstInReach {
  using DistanceType = double;
  double squared_reach;
  bool found = false;
  [[nodiscard]] std::size_t size() const { return 0; }
  [[nodiscard]] bool full() const { return true; }
  bool addPoint(double squared_distance, std::uint32_t /*point*/) {
    found = squared_distance <= squared_reach;
    return !found;
  }
  [[nodiscard]] double worstDist() const { return 1.000001 * squared_reach + 1e-18; }
  void sort() const {}  // nanoflann 1.5 and later calls it.
};

/// Collects the points of a search; the search prunes points beyond `worstDist`.
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

}  // namespace

template <class Point>
struct NearbyPoints<Point>::Tree : PointTree<Point, double> {
  using PointTree<Point, double>::PointTree;
};

template <class Point>
NearbyPoints<Point>::NearbyPoints(const std::vector<Point>& points, double reach)
    : squared_reach_(reach * reach) {
  if (points.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw DataError("a map of " + grouped_text(points.size()) +
                    " points is too large to search: expected fewer than 4,294,967,295. Use fewer "
                    "scans.");
  }
  if (!points.empty()) tree_ = std::make_unique<Tree>(points);
}

template <class Point>
NearbyPoints<Point>::~NearbyPoints() = default;

template <class Point>
bool NearbyPoints<Point>::has_near(const Eigen::Vector3d& query) const {
  if (tree_ == nullptr) return false;
  FirstInReach result{squared_reach_};
  tree_->search(query.data(), result);
  return result.found;
}

template class NearbyPoints<Eigen::Vector3d>;
template class NearbyPoints<Eigen::Vector3f>;

struct NearestLabels::Tree {
  explicit Tree(LabelledCloud points) : cloud(std::move(points)), tree(cloud.points) {}
  LabelledCloud cloud;
  PointTree<Eigen::Vector3d, double> tree;
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
      tree_->tree.search(queries[i].data(), collector);
      labels[i] = tree_->cloud.labels[vote.decide([](std::uint32_t) { return false; }).point];
    }
  });
  return labels;
}

}  // namespace raymoval
