// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/whole_things.h"

#include <algorithm>
#include <array>
#include <limits>

#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step.
/// Of the points of a thing that many scans agree with, at most this share is lower than the mean
/// of its dynamic ones, ...
constexpr double kMostLower = 0.1;
/// ... and at least this share in the columns of voxels of these, or beside them.
constexpr double kLeastAbove = 0.6;

using Column = std::array<std::int32_t, 3>;  ///< Of one cluster: its number, x and y.

/// What is known of a mixed cluster. Whole numbers give the same sums in any order of the points.
struct Thing {
  int dynamic = 0, settled = 0;
  int lower = 0, above = 0;    ///< How many of the settled points are.
  std::int64_t dynamic_z = 0;  ///< The sum of `z` of the dynamic points.
  Eigen::Array2i low = Eigen::Array2i::Constant(std::numeric_limits<int>::max());
  Eigen::Array2i high = Eigen::Array2i::Constant(std::numeric_limits<int>::lowest());
};

/// The mixed clusters of a scan, and the columns in which something of them is dynamic.
class WholeThings {
 public:
  WholeThings(const SegmentedScan& scan, const std::vector<std::uint8_t>& is_mixed,
              const EvidenceMap& map, const Parameters& parameters)
      : scan_(scan),
        is_mixed_(is_mixed),
        map_(map),
        parameters_(parameters),
        things_(scan.clusters.size()) {}

  void add_dynamic() {
    for_points([&](std::size_t k, int cluster, Thing& thing) {
      if (scan_.verdict[k] != Verdict::kDynamic) return;
      ++thing.dynamic;
      thing.dynamic_z += z(k);
      const Eigen::Array2i place(scan_.in_map.x[k], scan_.in_map.y[k]);
      thing.low = thing.low.min(place - 1);
      thing.high = thing.high.max(place + 1);
      columns_.push_back({cluster, place.x(), place.y()});
    });
    sort_columns();
    const std::vector<Column> of_points = columns_;
    for (const Column& column : of_points) {
      for (int n = 0; n < 9; ++n) {
        columns_.push_back({column[0], column[1] + n % 3 - 1, column[2] + n / 3 - 1});
      }
    }
    sort_columns();
  }
  void add_settled() {
    for_points([&](std::size_t k, int cluster, Thing& thing) {
      if (scan_.verdict[k] == Verdict::kDynamic) return;
      // Most points of walls lie beyond the box. They are not asked for whether they are settled.
      const Eigen::Array2i place(scan_.in_map.x[k], scan_.in_map.y[k]);
      const bool is_beyond = (place < thing.low).any() || (place > thing.high).any();
      if (!is_beyond && !is_settled(scan_.voxel[k], map_, parameters_)) return;
      ++thing.settled;
      if (z(k) * thing.dynamic < thing.dynamic_z) ++thing.lower;
      if (is_beyond) return;
      const Column column{cluster, place.x(), place.y()};
      if (std::binary_search(columns_.begin(), columns_.end(), column)) ++thing.above;
    });
  }
  [[nodiscard]] std::vector<std::uint8_t> found() const {
    std::vector<std::uint8_t> whole(things_.size(), 0);
    for (std::size_t c = 0; c < things_.size(); ++c) {
      const Thing& thing = things_[c];
      if (is_mixed_[c] == 0 || thing.settled == 0) continue;
      whole[c] =
          thing.lower <= kMostLower * thing.settled && thing.above >= kLeastAbove * thing.settled;
    }
    return whole;
  }

 private:
  /// Of a point, in 256ths of a voxel's edge.
  [[nodiscard]] std::int64_t z(std::size_t k) const {
    return std::int64_t{256} * scan_.in_map.z[k] + upward(scan_.in_map.parts[k]);
  }
  /// Calls `visit(point, cluster, thing)` for each point of a mixed cluster.
  template <class Visit>
  void for_points(Visit&& visit) {
    for (std::size_t i = 0; i < scan_.high_points.size(); ++i) {
      const auto cluster = static_cast<std::size_t>(scan_.cluster_of[i]);
      if (is_mixed_[cluster] == 0) continue;
      visit(scan_.high_points[i], scan_.cluster_of[i], things_[cluster]);
    }
  }
  void sort_columns() {
    std::sort(columns_.begin(), columns_.end());
    columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  }

  const SegmentedScan& scan_;
  const std::vector<std::uint8_t>& is_mixed_;
  const EvidenceMap& map_;
  const Parameters& parameters_;
  std::vector<Thing> things_;    ///< By cluster.
  std::vector<Column> columns_;  ///< Ascending.
};

}  // namespace

std::vector<std::uint8_t> find_whole_things(const SegmentedScan& scan,
                                            const std::vector<std::uint8_t>& is_mixed,
                                            const EvidenceMap& map, const Parameters& parameters) {
  WholeThings things(scan, is_mixed, map, parameters);
  things.add_dynamic();
  things.add_settled();
  return things.found();
}

}  // namespace raymoval::raymoval_plus_method
