// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eval/checked_scan.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval::dynamicmap {

/// The points of a scan by kind. Static, dynamic, out-of-range and ignored points add up
/// to the points that were read.
struct PointCounts {
  std::int64_t static_points = 0;
  std::int64_t dynamic_points = 0;  ///< Ego points included.
  std::int64_t ego = 0;             ///< Unlabelled points near the sensor, which are dynamic.
  std::int64_t out_of_range = 0;
  std::int64_t ignored = 0;

  PointCounts& operator+=(const PointCounts& other);
};

/// @throws DataError unless a static or a dynamic point is left to score against
void check_not_empty(const PointCounts& points);

/// The kind of a point in the protocol. An ignored point has no class, but it may be part of a map.
enum class Kind { kOutOfRange, kIgnored, kStatic, kDynamic };

inline bool is_truth(Kind kind) {
  return kind == Kind::kStatic || kind == Kind::kDynamic;
}

/// Decides which points belong to the benchmark's ground truth, and which of them move.
class TruthPoints {
 public:
  TruthPoints(const EvaluationInput& input, double maximum_range, double ego_range);

  /// Calls `visit(i, scan, kind, removed)` for each point i of a scan that is in range.
  template <class Visit>
  PointCounts visit_scan(const CheckedScan& loaded, Visit&& visit) const {
    PointCounts counts;
    for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
      const Kind kind = kind_of(loaded.scan.points[i], loaded.labels[i], counts);
      if (kind != Kind::kOutOfRange) visit(i, loaded.scan, kind, loaded.removed(i));
    }
    return counts;
  }

  /// Calls `visit(i, scan, kind)` for each flagged point i of a scan that is in range.
  template <class Visit>
  void visit_flagged(const CheckedScan& loaded, Visit&& visit) const {
    PointCounts counts;
    for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
      if (!loaded.removed(i)) continue;
      const Kind kind = kind_of(loaded.scan.points[i], loaded.labels[i], counts);
      if (kind != Kind::kOutOfRange) visit(i, loaded.scan, kind);
    }
  }

  /// The kind of a point. @param point sensor frame
  [[nodiscard]] Kind kind_of(const Eigen::Vector3f& point, std::uint32_t word) const {
    PointCounts counts;
    return kind_of(point, word, counts);
  }

  /// The counts of each scan. Progress is shown as `task`.
  /// @throws DataError if no point at all is left
  [[nodiscard]] std::vector<PointCounts> count(const std::string& task) const;

  [[nodiscard]] const EvaluationInput& input() const { return input_; }

 private:
  Kind kind_of(const Eigen::Vector3f& point, std::uint32_t word, PointCounts& counts) const;

  const EvaluationInput& input_;  ///< Outlives this object.
  LabelClasses classes_;
  double maximum_range_;
  double ego_range_;
};

}  // namespace raymoval::dynamicmap
