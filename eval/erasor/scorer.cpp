// SPDX-License-Identifier: MIT
#include "eval/erasor/scorer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "eval/erasor/accumulate.h"
#include "eval/erasor/map_passes.h"
#include "eval/erasor/matching.h"
#include "eval/erasor/rates.h"
#include "eval/points/cloud_masks.h"
#include "eval/points/nearest_labels.h"
#include "eval/scan_passes.h"

namespace raymoval::erasor {
namespace {

/// How the estimate lies in the truth, looked at the other way round.
struct Overlap {
  std::int64_t without_partner = 0;
  std::int64_t near = 0;  ///< Voxels with a truth voxel within half an edge.
};

Overlap overlap_of(const LabelledVoxels& estimate, const LabelledVoxels& truth,
                   const Options& options, int threads) {
  const std::vector<std::uint32_t> partners =
      find_partners(estimate, truth, options.voxel_size, MatchingOption::kRadius, threads);
  Overlap overlap;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    if (partners[i] == kNoPartner) {
      ++overlap.without_partner;
      continue;
    }
    const auto offset = truth.cloud.points[partners[i]] - estimate.cloud.points[i];
    if (offset.norm() <= 0.5 * options.voxel_size) ++overlap.near;
  }
  return overlap;
}

[[noreturn]] void throw_empty_truth(const PointCounts& points) {
  throw DataError(fmt::format(
      "nothing to score against: of {} points {} are out of range, {} have ignored labels and {} "
      "lie too near to the sensor; expected at least one that is left. Check range_m, the label "
      "rule and minimum_horizontal_range.",
      grouped_text(
          static_cast<std::uint64_t>(points.out_of_range + points.ignored + points.cropped)),
      points.out_of_range, points.ignored, points.cropped));
}

class ErasorScorer : public Scorer {
 public:
  ErasorScorer(const EvaluationInput& input, const Options& options)
      : Scorer(input), options_(options), classes_(effective_rule(input.label_rule, options)) {
    build_truth();
    if (options_.label_mode == LabelMode::kNearest) {
      dense_ = std::make_unique<NearestLabels>(
          accumulate(this->input(), options_, classes_, "points for labels").cloud);
    }
  }

  [[nodiscard]] std::unique_ptr<Scoring> start() const override {
    return std::make_unique<ErasorScoring>(*this);
  }

  [[nodiscard]] ProtocolResult score_cloud(const CloudEstimate& cloud) const override {
    if (options_.label_mode != LabelMode::kNearest) {
      throw UsageError("a cloud has no labels by index: expected label_mode = nearest.");
    }
    if (options_.frame != FrameOption::kSequence) {
      throw UsageError(
          "a cloud stands in the frame of the sequence's poses: expected frame = sequence.");
    }
    ProtocolResult result = result_of(cloud_map(cloud.points()), truth_points_);
    std::erase_if(result.counts, [](const auto& count) { return count.first == "removed_points"; });
    result.counts.emplace_back("cloud_points", static_cast<std::int64_t>(cloud.points().size()));
    return result;
  }

 private:
  class ErasorScoring : public Scoring {
   public:
    explicit ErasorScoring(const ErasorScorer& scorer)
        : scorer_(scorer), map_(scorer.rules(), scorer.cells_, MapPasses::Labels::kClasses) {}

    bool begin_pass(std::size_t slots) override { return map_.begin_pass(slots); }
    void read(const CheckedScan& scan, std::size_t slot) override { map_.read(scan, slot); }
    void take(std::size_t slot) override { map_.take(slot); }
    ProtocolResult result() override {
      LabelledVoxels map = map_.finish(nullptr);
      if (scorer_.dense_) {
        map.cloud.labels = scorer_.dense_->labels_of(map.cloud.points, scorer_.input().threads);
      }
      return scorer_.result_of(map, map_.points());
    }

   private:
    const ErasorScorer& scorer_;
    MapPasses map_;
  };

  [[nodiscard]] MapRules rules() const { return {input(), options_, classes_}; }

  void build_truth() {
    MapCellsPass cells(rules());
    run_passes(input(), "cells of the map", {&cells});
    cells_ = cells.cells();
    MapPasses map(rules(), cells_, MapPasses::Labels::kExact);
    run_passes(input(), "ground truth map", {&map});
    truth_ = map.finish(&scan_of_voxel_);
    truth_points_ = map.points();
    if (truth_.size() == 0) throw_empty_truth(truth_points_);
  }

  /// The voxelised cloud, each voxel with the label of its nearest point in the dense map. Points
  /// of ignored labels stand in that map too, and what lies nearest to one is ignored likewise.
  [[nodiscard]] LabelledVoxels cloud_map(const std::vector<Eigen::Vector3f>& points) const {
    LabelledCloud cloud;
    for (const Eigen::Vector3f& point : points) cloud.points.push_back(point.cast<double>());
    cloud.labels.resize(points.size());
    const LabelledVoxels all = voxelise(cloud, options_.voxel_size, classes_, input().threads);
    if (all.size() == 0) return all;
    EvaluationInput whole = input();
    whole.label_rule.ignored.clear();
    const LabelClasses whole_classes(effective_rule(whole.label_rule, options_));
    const NearestLabels dense(
        accumulate(whole, options_, whole_classes, "points for labels").cloud);
    const std::vector<std::uint32_t> labels = dense.labels_of(all.cloud.points, input().threads);
    LabelledVoxels map;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (classes_.of(labels[i]) == LabelClass::kIgnored) continue;
      map.keys.push_back(all.keys[i]);
      map.cloud.points.push_back(all.cloud.points[i]);
      map.cloud.labels.push_back(labels[i]);
    }
    return map;
  }

  /// @param points what became of the points that the estimate was made of
  [[nodiscard]] ProtocolResult result_of(const LabelledVoxels& estimate,
                                         const PointCounts& points) const {
    const std::vector<std::uint32_t> partners =
        find_partners(truth_, estimate, options_.voxel_size, options_.matching, input().threads);
    const Overlap overlap = overlap_of(estimate, truth_, options_, input().threads);
    ProtocolResult result;
    result.protocol = "erasor";
    add_matches(count_matches(truth_, estimate, partners, classes_, options_), "", result);
    add_map_counts(estimate, overlap, points, result);
    add_no_truck(estimate, partners, result);
    result.intervals = intervals_of(count_matches_by_scan(
        truth_, estimate, partners, scan_of_voxel_, input().scans->size(), classes_, options_));
    add_warnings(estimate, overlap, result);
    return result;
  }

  void add_map_counts(const LabelledVoxels& estimate, const Overlap& overlap,
                      const PointCounts& points, ProtocolResult& result) const {
    const auto unlabelled =
        std::count_if(truth_.cloud.labels.begin(), truth_.cloud.labels.end(),
                      [](std::uint32_t word) { return semantic_id(word) <= 1; });
    result.counts.insert(result.counts.end(),
                         {{"estimate_voxels", static_cast<std::int64_t>(estimate.size())},
                          {"estimate_voxels_without_partner", overlap.without_partner},
                          {"mixed_label_ties", truth_.mixed_label_ties},
                          {"estimate_mixed_label_ties", estimate.mixed_label_ties},
                          {"unlabelled_voxels", unlabelled},
                          {"evaluated_points", points.evaluated},
                          {"removed_points", points.removed},
                          {"out_of_range_points", points.out_of_range},
                          {"ignored_points", points.ignored},
                          {"cropped_points", points.cropped}});
  }

  /// The same voxels with trucks counted as static. Labels travel by point and not by class, so
  /// the maps and the partners stay as they are.
  void add_no_truck(const LabelledVoxels& estimate, const std::vector<std::uint32_t>& partners,
                    ProtocolResult& result) const {
    Options without = options_;
    without.truck_is_moving = false;
    const LabelRule with_trucks = effective_rule(input().label_rule, options_);
    const LabelRule without_trucks = effective_rule(input().label_rule, without);
    if (truth_points_.trucks == 0 || with_trucks.moving == without_trucks.moving) return;
    add_matches(count_matches(truth_, estimate, partners, LabelClasses(without_trucks), without),
                kNoTruck, result);
  }

  void add_warnings(const LabelledVoxels& estimate, const Overlap& overlap,
                    ProtocolResult& result) const {
    if (estimate.size() == 0) {
      result.warnings.push_back("the estimate is empty: the method removed every evaluated point");
    } else if (2 * overlap.near < static_cast<std::int64_t>(estimate.size())) {
      result.warnings.push_back(
          "more than half of the estimate's voxels lie over " +
          number_text(0.5 * options_.voxel_size) +
          " m from the ground truth; are both in the same frame, made from the same scans?");
    }
  }

  Options options_;
  LabelClasses classes_;
  MapCells cells_;
  LabelledVoxels truth_;
  PointCounts truth_points_;
  /// For each voxel of the truth the scan whose point gave it its label.
  std::vector<std::uint32_t> scan_of_voxel_;
  /// The dense map, searchable; it is only kept if the estimate's labels are taken from it.
  std::unique_ptr<NearestLabels> dense_;
};

}  // namespace

std::unique_ptr<Scorer> make_scorer(const EvaluationInput& input, const Options& options) {
  return std::make_unique<ErasorScorer>(input, options);
}

}  // namespace raymoval::erasor
