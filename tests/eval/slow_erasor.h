// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "tests/eval/memory_sequence.h"

namespace raymoval::test {

/// A second implementation of the ERASOR protocol, written from its description with loops over all
/// pairs. Shares no code with eval/.
class SlowErasor {
 public:
  struct Options {
    double voxel_size = 0.2;
    bool geometry = false, same_cell = false, nearest_labels = false, ignore_0_1 = false;
  };
  struct Counts {
    std::int64_t static_voxels = 0, dynamic_voxels = 0, preserved_static = 0, remaining_dynamic = 0,
                 estimate_voxels = 0, without_partner = 0, mixed_ties = 0;
  };

  SlowErasor(const EvaluationInput& input, const Options& options)
      : input_(input), options_(options) {}

  [[nodiscard]] Counts score(const std::vector<LabelledScan>& scans, const MaskStore& masks) const {
    Counts counts;
    std::int64_t unused = 0;
    const Cloud dense = dense_map(scans, nullptr, counts.mixed_ties);
    const Cloud truth = voxels(dense, counts.mixed_ties);
    Cloud estimate = voxels(dense_map(scans, &masks, unused), unused);
    if (options_.nearest_labels) {
      for (Point& point : estimate) point.label = nearest_label(dense, point.at, unused);
    }
    counts.estimate_voxels = static_cast<std::int64_t>(estimate.size());
    for (const Point& point : truth) count(point, estimate, counts);
    for (const Point& point : estimate) {
      if (partner(point, truth, false) == nullptr) ++counts.without_partner;
    }
    return counts;
  }

 private:
  struct Point {
    Eigen::Vector3d at;
    std::uint32_t label;
    std::array<std::int64_t, 3> cell{};  ///< z, y, x.
  };
  using Cloud = std::vector<Point>;

  [[nodiscard]] bool moving(std::uint32_t word) const {
    return input_.label_rule.classify(word) == LabelClass::kMoving;
  }

  [[nodiscard]] Cloud dense_map(const std::vector<LabelledScan>& scans, const MaskStore* masks,
                                std::int64_t& ties) const {
    Cloud dense;
    for (std::size_t s = 0; s < scans.size(); ++s) {
      Cloud placed;
      for (std::size_t i = 0; i < scans[s].points.size(); ++i) {
        Eigen::Vector3d p = scans[s].points[i].cast<double>();
        const double range = std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
        if (range < input_.range_m.min || range > input_.range_m.max) continue;
        if (input_.label_rule.classify(scans[s].labels[i]) == LabelClass::kIgnored) continue;
        if (p.x() * p.x() + p.y() * p.y() < 2.7 * 2.7) continue;
        if (masks != nullptr && masks->get(s)[i] != 0) continue;
        p.z() += 1.73;
        placed.push_back({scans[s].pose * p, scans[s].labels[i]});
      }
      const Cloud voxelised = voxels(placed, ties);
      dense.insert(dense.end(), voxelised.begin(), voxelised.end());
    }
    return dense;
  }

  [[nodiscard]] Cloud voxels(const Cloud& cloud, std::int64_t& ties) const {
    std::map<std::array<std::int64_t, 3>, std::vector<const Point*>> cells;
    const double inverse = 1.0 / options_.voxel_size;
    for (const Point& point : cloud) {
      std::array<std::int64_t, 3> cell{};
      for (int axis = 0; axis < 3; ++axis) {
        cell[static_cast<std::size_t>(2 - axis)] =
            static_cast<std::int64_t>(std::floor(point.at[axis] * inverse));
      }
      cells[cell].push_back(&point);
    }
    Cloud result;
    for (const auto& [cell, points] : cells) {
      const Eigen::Vector3d first = points.front()->at;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Point* point : points) sum += point->at - first;
      const Eigen::Vector3d mean = first + sum / static_cast<double>(points.size());
      result.push_back({mean, nearest_label(cloud, mean, ties), cell});
    }
    return result;
  }

  [[nodiscard]] std::uint32_t nearest_label(const Cloud& cloud, const Eigen::Vector3d& query,
                                            std::int64_t& ties) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point& point : cloud) nearest = std::min(nearest, (point.at - query).norm());
    const Point* winner = nullptr;
    bool mixed = false;
    for (const Point& point : cloud) {
      if ((point.at - query).norm() > nearest + 1e-9) continue;
      if (winner == nullptr) winner = &point;
      mixed = mixed || moving(point.label) != moving(winner->label);
    }
    ties += mixed ? 1 : 0;
    return winner->label;
  }

  [[nodiscard]] const Point* partner(const Point& query, const Cloud& cloud, bool same_cell) const {
    const Point* found = nullptr;
    double best = std::numeric_limits<double>::infinity();
    for (const Point& point : cloud) {
      if (same_cell) {
        if (point.cell == query.cell) return &point;
        continue;
      }
      const double squared = (point.at - query.at).squaredNorm();
      if (squared < best) {
        best = squared;
        found = &point;
      }
    }
    const double limit = options_.voxel_size * std::sqrt(3.0) / 2.0;
    return found != nullptr && std::sqrt(best) < limit ? found : nullptr;
  }

  void count(const Point& point, const Cloud& estimate, Counts& counts) const {
    const bool moves = moving(point.label);
    if (options_.ignore_0_1 && !moves && (point.label & 0xFFFFU) <= 1) return;
    (moves ? counts.dynamic_voxels : counts.static_voxels) += 1;
    const Point* other = partner(point, estimate, options_.same_cell);
    if (other == nullptr) return;
    if (!options_.geometry && moving(other->label) != moves) return;
    (moves ? counts.remaining_dynamic : counts.preserved_static) += 1;
  }

  EvaluationInput input_;
  Options options_;
};

}  // namespace raymoval::test
