// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "core/error.h"
#include "eval/built_in_protocols.h"
#include "eval/dynamicmap/accuracy.h"
#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/truth_points.h"
#include "eval/points/cloud_masks.h"
#include "eval/scan_passes.h"

namespace raymoval {
namespace {

using namespace dynamicmap;

constexpr std::uint8_t kStatic = 1;
constexpr std::uint8_t kDynamic = 2;

std::vector<CountSpec> voxel_count_list() {
  return {{"static_voxels", true},       {"dynamic_voxels", true}, {"preserved_static"},
          {"remaining_dynamic"},         {"mixed_voxels", true},   {"ego_points", true},
          {"out_of_range_points", true}, {"ignored_points", true}};
}

class StrictScorer : public Scorer {
 public:
  StrictScorer(const EvaluationInput& evaluated, const StrictOptions& options)
      : Scorer(evaluated),
        voxel_size_(options.voxel_size),
        points_(input(), options.maximum_range, options.ego_range) {
    for (const PointCounts& scan : points_.count("ground truth points")) point_counts_ += scan;
    using Part = std::vector<std::pair<VoxelKey, bool>>;  // Cell, and whether the point moves.
    std::vector<Part> slots(usual_slots(input()));
    const auto read = [&](std::size_t scan, std::size_t slot) {
      Part& part = slots[slot];
      part.clear();
      (void)points_.visit_scan(load_checked(input(), nullptr, scan),
                               [&](std::size_t p, const Scan& loaded, Kind kind, bool) {
                                 if (!is_truth(kind)) return;
                                 part.emplace_back(key_of(loaded, p), kind == Kind::kDynamic);
                               });
    };
    in_scan_order(input(), "ground truth cells", slots.size(), read, [&](std::size_t slot) {
      for (const auto& [key, moving] : slots[slot]) add_cell(key, moving);
    });
  }

  [[nodiscard]] std::unique_ptr<Scoring> start() const override {
    return std::make_unique<StrictScoring>(*this);
  }

  [[nodiscard]] ProtocolResult score_cloud(const CloudEstimate& cloud) const override {
    return score(cloud.masks(input(), kCloudDistance));
  }

 private:
  class StrictScoring : public Scoring {
   public:
    explicit StrictScoring(const StrictScorer& scorer)
        : scorer_(scorer), kept_(scorer.classes_.size(), 0) {}

    bool begin_pass(std::size_t /*slots*/) override { return ++pass_ == 1; }
    void read(const CheckedScan& scan, std::size_t /*slot*/) override {
      scorer_.add_kept(scan, kept_);
    }
    void take(std::size_t /*slot*/) override {}
    ProtocolResult result() override { return scorer_.result_of(kept_); }

   private:
    const StrictScorer& scorer_;
    int pass_ = 0;
    std::vector<std::uint8_t>
        kept_;  ///< For each cell of the truth the classes of its kept points.
  };

  [[nodiscard]] VoxelKey key_of(const Scan& scan, std::size_t point) const {
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[point].cast<double>();
    return voxel_key(voxel_index(world, 1.0 / voxel_size_));
  }

  void add_cell(VoxelKey key, bool moving) {
    const auto next = static_cast<std::uint32_t>(classes_.size());
    const auto [cell, added] = positions_.insert({key, next});
    if (added) classes_.push_back(0);
    if (classes_.size() == std::numeric_limits<std::uint32_t>::max()) {
      throw DataError(
          "the map has too many cells: expected fewer than 4,294,967,295. Use fewer "
          "scans or larger voxels.");
    }
    classes_[cell->second] |= moving ? kDynamic : kStatic;
  }

  /// Adds the classes of a scan's kept points to their cells. Several threads may call it at a
  /// time.
  void add_kept(const CheckedScan& loaded, std::vector<std::uint8_t>& kept) const {
    (void)points_.visit_scan(loaded, [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
      if (removed || !is_truth(kind)) return;
      std::uint8_t& cell = kept[positions_.at(key_of(scan, p))];
      std::atomic_ref<std::uint8_t>(cell).fetch_or(kind == Kind::kDynamic ? kDynamic : kStatic,
                                                   std::memory_order_relaxed);
    });
  }

  [[nodiscard]] ProtocolResult result_of(const std::vector<std::uint8_t>& kept) const {
    const auto count = [](const std::vector<std::uint8_t>& cells, std::uint8_t wanted) {
      return static_cast<std::int64_t>(
          std::count_if(cells.begin(), cells.end(),
                        [wanted](std::uint8_t cell) { return (cell & wanted) == wanted; }));
    };
    const std::int64_t static_voxels = count(classes_, kStatic);
    const std::int64_t dynamic_voxels = count(classes_, kDynamic);
    const std::int64_t preserved = count(kept, kStatic);
    const std::int64_t remaining = count(kept, kDynamic);
    ProtocolResult result;
    result.protocol = "dynamicmap-strict";
    result.counts =
        named_counts(voxel_count_list(), {static_voxels, dynamic_voxels, preserved, remaining,
                                          count(classes_, kStatic | kDynamic), point_counts_.ego,
                                          point_counts_.out_of_range, point_counts_.ignored});
    result.rates = accuracy_rates(preserved, static_voxels, dynamic_voxels - remaining,
                                  dynamic_voxels, "voxel");
    if (preserved + remaining == 0) {
      result.warnings.push_back("the estimate is empty: every evaluated point is removed");
    }
    return result;
  }

  double voxel_size_;
  TruthPoints points_;
  PointCounts point_counts_;
  VoxelMap<std::uint32_t> positions_;  ///< Position of each cell of the truth in `classes_`.
  std::vector<std::uint8_t> classes_;  ///< kStatic, kDynamic or both.
};

}  // namespace

/// SA, DA, AA and HA over sets of cells. There is no search, so nothing depends on a neighbour, an
/// order or a tie.
///
/// The truth of the `dynamicmap` protocol, as two sets of cells on the lattice anchored at the
/// world origin: cells with a static point and cells with a dynamic point (a cell may be in both).
/// A static cell is preserved if a static point in it is kept, a dynamic one is cleared if no
/// dynamic point in it is kept. So the oracle has SA 100 and DA 100, and neither a neighbour within
/// reach nor a kept point of the other class helps. A cleaned cloud keeps the points that lie
/// within 0.05 m of it.
///
/// Counts: static_voxels, dynamic_voxels, preserved_static, remaining_dynamic; mixed_voxels, which
/// are in both sets; ego_points, out_of_range_points, ignored_points.
ProtocolEntry strict_protocol_entry() {
  return {.name = "dynamicmap-strict",
          .version = "1",
          .sentence =
              "Static and dynamic accuracy over sets of cells, by index, without any search: SA, "
              "DA, AA, HA.",
          .parameters = strict_option_table().specs(),
          .rates = accuracy_rate_list(),
          .counts = voxel_count_list(),
          .open = [](const EvaluationInput& input,
                     const Configuration& options) -> std::unique_ptr<Scorer> {
            return std::make_unique<StrictScorer>(input, strict_option_table().read(options));
          }};
}

}  // namespace raymoval
