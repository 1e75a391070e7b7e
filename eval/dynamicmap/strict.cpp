// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/strict.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/truth_points.h"
#include "eval/points/cloud_masks.h"

namespace raymoval {
namespace {

using namespace dynamicmap;

constexpr std::uint8_t kStatic = 1;
constexpr std::uint8_t kDynamic = 2;

/// Cells of the truth: where each stands in a list, and what it holds.
class StrictTruth : public TruthMap {
 public:
  VoxelMap<std::uint32_t> positions;
  std::vector<std::uint8_t> classes;  ///< kStatic, kDynamic or both.
  PointCounts points;
};

class StrictProtocol : public Protocol {
 public:
  explicit StrictProtocol(const StrictOptions& options) : options_(options) {}
  [[nodiscard]] std::string name() const override { return "dynamicmap-strict"; }
  [[nodiscard]] std::string version() const override { return "1"; }
  [[nodiscard]] Configuration options() const override {
    return strict_option_table().write(options_);
  }

  [[nodiscard]] std::unique_ptr<TruthMap> prepare(const EvaluationInput& input) const override {
    check_input(input, name());
    const TruthPoints points = truth_points(input);
    auto truth = std::make_unique<StrictTruth>();
    for (const PointCounts& scan : points.count("ground truth points")) truth->points += scan;
    if (input.progress != nullptr) input.progress->begin("ground truth cells", input.scans->size());
    for (std::size_t i = 0; i < input.scans->size(); ++i) {
      (void)points.read(i, nullptr, [&](std::size_t p, const Scan& scan, Kind kind, bool) {
        if (is_truth(kind)) add_cell(key_of(scan, p), kind == Kind::kDynamic, *truth);
      });
      if (input.progress != nullptr) input.progress->advance();
    }
    if (input.progress != nullptr) input.progress->end();
    return truth;
  }

  [[nodiscard]] ProtocolResult score(const EvaluationInput& input, const TruthMap& truth_map,
                                     const MaskStore& masks) const override {
    check_input(input, name());
    check_mask_count(input, masks);
    const auto* truth = dynamic_cast<const StrictTruth*>(&truth_map);
    if (truth == nullptr) {
      throw InternalError("protocol " + name() + " was given a truth that it did not prepare");
    }
    return result_of(*truth, kept_cells(input, *truth, masks));
  }

  [[nodiscard]] ProtocolResult score_cloud(const EvaluationInput& input, const TruthMap& truth,
                                           const CloudEstimate& cloud) const override {
    return score(input, truth, cloud.masks(input, kCloudDistance));
  }

 private:
  [[nodiscard]] TruthPoints truth_points(const EvaluationInput& input) const {
    return {input, options_.maximum_range, options_.ego_range};
  }

  [[nodiscard]] VoxelKey key_of(const Scan& scan, std::size_t point) const {
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[point].cast<double>();
    return voxel_key(voxel_index(world, 1.0 / options_.voxel_size));
  }

  static void add_cell(VoxelKey key, bool moving, StrictTruth& truth) {
    const auto next = static_cast<std::uint32_t>(truth.classes.size());
    const auto [cell, added] = truth.positions.insert({key, next});
    if (added) truth.classes.push_back(0);
    if (truth.classes.size() == std::numeric_limits<std::uint32_t>::max()) {
      throw DataError(
          "the map has too many cells: expected fewer than 4,294,967,295. Use fewer "
          "scans or larger voxels.");
    }
    truth.classes[cell->second] |= moving ? kDynamic : kStatic;
  }

  /// For each cell of the truth the classes of its kept points.
  [[nodiscard]] std::vector<std::uint8_t> kept_cells(const EvaluationInput& input,
                                                     const StrictTruth& truth,
                                                     const MaskStore& masks) const {
    const TruthPoints points = truth_points(input);
    std::vector<std::uint8_t> kept(truth.classes.size(), 0);
    if (input.progress != nullptr) input.progress->begin("kept cells", input.scans->size());
    parallel_for(input.threads, input.scans->size(), 1, [&](std::size_t i) {
      const auto visit = [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
        if (removed || !is_truth(kind)) return;
        std::uint8_t& cell = kept[truth.positions.at(key_of(scan, p))];
        std::atomic_ref<std::uint8_t>(cell).fetch_or(kind == Kind::kDynamic ? kDynamic : kStatic,
                                                     std::memory_order_relaxed);
      };
      (void)points.read(i, &masks, visit);
      if (input.progress != nullptr) input.progress->advance();
    });
    if (input.progress != nullptr) input.progress->end();
    return kept;
  }

  [[nodiscard]] ProtocolResult result_of(const StrictTruth& truth,
                                         const std::vector<std::uint8_t>& kept) const {
    const auto count = [](const std::vector<std::uint8_t>& cells, std::uint8_t wanted) {
      return static_cast<std::int64_t>(
          std::count_if(cells.begin(), cells.end(),
                        [wanted](std::uint8_t cell) { return (cell & wanted) == wanted; }));
    };
    const std::int64_t static_voxels = count(truth.classes, kStatic);
    const std::int64_t dynamic_voxels = count(truth.classes, kDynamic);
    const std::int64_t preserved = count(kept, kStatic);
    const std::int64_t remaining = count(kept, kDynamic);
    ProtocolResult result;
    result.protocol = name();
    result.counts = {{"static_voxels", static_voxels},
                     {"dynamic_voxels", dynamic_voxels},
                     {"preserved_static", preserved},
                     {"remaining_dynamic", remaining},
                     {"mixed_voxels", count(truth.classes, kStatic | kDynamic)},
                     {"ego_points", truth.points.ego},
                     {"out_of_range_points", truth.points.out_of_range},
                     {"ignored_points", truth.points.ignored}};
    result.rates = accuracy_rates(preserved, static_voxels, dynamic_voxels - remaining,
                                  dynamic_voxels, "voxel");
    if (preserved + remaining == 0) {
      result.warnings.push_back("the estimate is empty: every evaluated point is removed");
    }
    return result;
  }

  StrictOptions options_;
};

}  // namespace

ProtocolEntry strict_protocol_entry() {
  return {"dynamicmap-strict",
          "Static and dynamic accuracy over sets of cells, by index, without any search: SA, DA, "
          "AA, HA.",
          strict_option_table().specs()};
}

std::unique_ptr<Protocol> make_strict_protocol(const Configuration& options) {
  return std::make_unique<StrictProtocol>(strict_option_table().read(options));
}

}  // namespace raymoval
