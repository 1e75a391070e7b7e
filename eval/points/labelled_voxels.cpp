// SPDX-License-Identifier: MIT
#include "eval/points/labelled_voxels.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "eval/points/cell_neighbours.h"
#include "eval/points/nearest_points.h"

namespace raymoval {
namespace {

constexpr std::size_t kGrain = 16384;

/// A point and the cell in which it lies.
struct CellPoint {
  VoxelKey key;
  std::uint32_t point;
};

/// The input points by cell: the points of cell i are order[first[i]] .. order[first[i + 1] - 1].
struct Cells {
  std::vector<VoxelKey> keys;
  std::vector<std::size_t> first;
  std::vector<CellPoint> order;
};

Cells group_by_cell(const LabelledCloud& cloud, double voxel_size, int threads) {
  Cells cells;
  cells.order.resize(cloud.size());
  const double inverse = 1.0 / voxel_size;
  parallel_for(threads, cloud.size(), kGrain, [&](std::size_t i) {
    cells.order[i] = {voxel_key(voxel_index(cloud.points[i], inverse)),
                      static_cast<std::uint32_t>(i)};
  });
  std::sort(cells.order.begin(), cells.order.end(), [](const CellPoint& a, const CellPoint& b) {
    return a.key != b.key ? a.key < b.key : a.point < b.point;
  });
  for (std::size_t i = 0; i < cells.order.size(); ++i) {
    if (i > 0 && cells.order[i].key == cells.order[i - 1].key) continue;
    cells.keys.push_back(cells.order[i].key);
    cells.first.push_back(i);
  }
  cells.first.push_back(cells.order.size());
  return cells;
}

Eigen::Vector3d centroid(const LabelledCloud& cloud, const Cells& cells, std::size_t cell) {
  OffsetMean mean;
  for (std::size_t i = cells.first[cell]; i < cells.first[cell + 1]; ++i) {
    mean.add(cloud.points[cells.order[i].point]);
  }
  return mean.mean();
}

/// Fills voxels [begin, end). The nearest point is never farther than half a cell's diagonal (the
/// cell's own points have their mean there), so the 27 cells around hold it.
/// @return number of mixed-label ties
std::int64_t fill_voxels(const LabelledCloud& cloud, const Cells& cells, double voxel_size,
                         const LabelClasses& classes, std::size_t begin, std::size_t end,
                         LabelledVoxels& voxels) {
  std::int64_t mixed_ties = 0;
  CellNeighbours neighbours(cells.keys, voxel_size);
  LabelVote vote;
  for (std::size_t cell = begin; cell < end; ++cell) {
    const Eigen::Vector3d mean = centroid(cloud, cells, cell);
    vote.clear();
    neighbours.visit(
        cells.keys[cell], mean, [&] { return vote.reach(); },
        [&](std::size_t near) {
          for (std::size_t i = cells.first[near]; i < cells.first[near + 1]; ++i) {
            const std::uint32_t point = cells.order[i].point;
            vote.offer((cloud.points[point] - mean).squaredNorm(), point);
          }
        });
    const LabelVote::Result result =
        vote.decide([&](std::uint32_t point) { return classes.moving(cloud.labels[point]); });
    voxels.cloud.points[cell] = mean;
    voxels.cloud.labels[cell] = cloud.labels[result.point];
    voxels.label_points[cell] = result.point;
    mixed_ties += result.mixed_tie ? 1 : 0;
  }
  return mixed_ties;
}

}  // namespace

void LabelledCloud::append(const LabelledCloud& other) {
  points.insert(points.end(), other.points.begin(), other.points.end());
  labels.insert(labels.end(), other.labels.begin(), other.labels.end());
}

LabelClasses::LabelClasses(const LabelRule& rule) : table_(0x10000) {
  for (std::uint32_t id = 0; id < table_.size(); ++id) table_[id] = rule.classify(id);
}

LabelledVoxels voxelise(const LabelledCloud& cloud, double voxel_size, const LabelClasses& classes,
                        int threads) {
  if (cloud.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw DataError("a map of " + grouped_text(cloud.size()) +
                    " points is too large to voxelise: expected fewer than 4,294,967,295. Use "
                    "fewer scans or larger voxels.");
  }
  Cells cells = group_by_cell(cloud, voxel_size, threads);
  LabelledVoxels voxels;
  voxels.cloud.points.resize(cells.keys.size());
  voxels.cloud.labels.resize(cells.keys.size());
  voxels.label_points.resize(cells.keys.size());
  std::vector<std::int64_t> ties(cells.keys.size() / kGrain + 1, 0);
  parallel_chunks(threads, cells.keys.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    ties[begin / kGrain] = fill_voxels(cloud, cells, voxel_size, classes, begin, end, voxels);
  });
  for (const std::int64_t count : ties) voxels.mixed_label_ties += count;
  voxels.keys = std::move(cells.keys);
  return voxels;
}

}  // namespace raymoval
