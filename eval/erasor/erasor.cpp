// SPDX-License-Identifier: MIT
#include "eval/erasor/erasor.h"

#include <algorithm>
#include <utility>

#include "core/text.h"
#include "eval/erasor/accumulate.h"
#include "eval/erasor/matching.h"
#include "eval/erasor/options.h"
#include "eval/points/checked_scan.h"
#include "eval/points/cloud_masks.h"
#include "eval/points/nearest_labels.h"
#include "eval/rates.h"

namespace raymoval {
namespace {

using namespace erasor;

class ErasorTruth : public TruthMap {
 public:
  LabelledVoxels map;
  PointCounts points;
  /// For each voxel of the map the scan whose point gave it its label.
  std::vector<std::uint32_t> scan_of_voxel;
  /// The dense map, searchable; only kept where labels are taken from it again.
  std::unique_ptr<NearestLabels> dense;
};

void add_rates(const MatchCounts& counts, const std::string& suffix, std::vector<Rate>& rates) {
  const Rate preservation =
      percent_rate("PR" + suffix, counts.preserved_static, counts.static_voxels,
                   "the ground truth has no static voxel");
  const Rate rejection =
      percent_rate("RR" + suffix, counts.dynamic_voxels - counts.remaining_dynamic,
                   counts.dynamic_voxels, "the ground truth has no dynamic voxel");
  Rate f1{"F1" + suffix, std::nullopt};
  if (preservation.value && rejection.value) {
    f1.value = f1_from_percent(*preservation.value, *rejection.value);
  } else {
    f1.undefined_reason =
        preservation.value ? rejection.undefined_reason : preservation.undefined_reason;
  }
  rates.insert(rates.end(), {preservation, rejection, f1});
}

void add_counts(const MatchCounts& counts, const std::string& suffix, ProtocolResult& result) {
  result.counts.emplace_back("static_voxels" + suffix, counts.static_voxels);
  result.counts.emplace_back("dynamic_voxels" + suffix, counts.dynamic_voxels);
  result.counts.emplace_back("preserved_static" + suffix, counts.preserved_static);
  result.counts.emplace_back("remaining_dynamic" + suffix, counts.remaining_dynamic);
}

Intervals intervals_of(const std::vector<MatchCounts>& scans) {
  std::vector<std::vector<std::int64_t>> counts;
  for (const MatchCounts& scan : scans) {
    counts.push_back(
        {scan.static_voxels, scan.dynamic_voxels, scan.preserved_static, scan.remaining_dynamic});
  }
  return bootstrap(counts, [](const std::vector<std::int64_t>& sums) {
    std::vector<Rate> rates;
    add_rates({sums[0], sums[1], sums[2], sums[3]}, "", rates);
    return rates;
  });
}

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

class ErasorProtocol : public Protocol {
 public:
  explicit ErasorProtocol(const Options& options) : options_(options) {}
  [[nodiscard]] std::string name() const override { return "erasor"; }
  [[nodiscard]] std::string version() const override { return "1"; }
  [[nodiscard]] Configuration options() const override { return option_table().write(options_); }
  [[nodiscard]] bool reads_calibration() const override {
    return options_.frame == FrameOption::kErasor;
  }

  [[nodiscard]] std::unique_ptr<TruthMap> prepare(const EvaluationInput& input) const override {
    check(input);
    const LabelClasses classes(effective_rule(input.label_rule, options_));
    DenseMap dense = accumulate(input, options_, classes, nullptr, "ground truth map");
    auto truth = std::make_unique<ErasorTruth>();
    truth->map = voxelise(dense.cloud, options_.voxel_size, classes, input.threads);
    truth->map.mixed_label_ties += dense.mixed_label_ties;
    truth->points = dense.points;
    for (const std::uint32_t point : truth->map.label_points) {
      truth->scan_of_voxel.push_back(dense.scan_of(point));
    }
    if (truth->map.size() == 0) throw_empty_truth(dense.points);
    if (options_.label_mode == LabelMode::kNearest) {
      truth->dense = std::make_unique<NearestLabels>(std::move(dense.cloud));
    }
    return truth;
  }

  [[nodiscard]] ProtocolResult score(const EvaluationInput& input, const TruthMap& truth_map,
                                     const MaskStore& masks) const override {
    check(input);
    const auto* truth = dynamic_cast<const ErasorTruth*>(&truth_map);
    if (truth == nullptr || (options_.label_mode == LabelMode::kNearest && !truth->dense)) {
      throw InternalError("protocol erasor was given a truth map that it did not prepare");
    }
    check_mask_count(input, masks);
    const LabelClasses classes(effective_rule(input.label_rule, options_));
    PointCounts points;
    const LabelledVoxels estimate = estimate_map(input, *truth, classes, masks, points);
    return result_of(input, *truth, estimate, classes, points);
  }

  [[nodiscard]] ProtocolResult score_cloud(const EvaluationInput& input, const TruthMap& truth_map,
                                           const CloudEstimate& cloud) const override {
    check(input);
    const auto* truth = dynamic_cast<const ErasorTruth*>(&truth_map);
    if (truth == nullptr) {
      throw InternalError("protocol erasor was given a truth map that it did not prepare");
    }
    if (options_.label_mode != LabelMode::kNearest) {
      throw UsageError("a cloud has no labels by index: expected label_mode = nearest.");
    }
    if (options_.frame != FrameOption::kSequence) {
      throw UsageError(
          "a cloud stands in the frame of the sequence's poses: expected frame = sequence.");
    }
    const LabelClasses classes(effective_rule(input.label_rule, options_));
    const LabelledVoxels estimate = cloud_map(input, classes, cloud.points());
    ProtocolResult result = result_of(input, *truth, estimate, classes, truth->points);
    std::erase_if(result.counts, [](const auto& count) { return count.first == "removed_points"; });
    result.counts.emplace_back("cloud_points", static_cast<std::int64_t>(cloud.points().size()));
    return result;
  }

 private:
  void check(const EvaluationInput& input) const {
    check_input(input, name());
    if (!reads_calibration() || input.T_camera_lidar) return;
    throw DataError(
        "protocol erasor with frame = erasor needs a sequence with poses of a camera and their "
        "calibration (calib.txt, row Tr); the poses of this one are those of the LiDAR. Leave the "
        "option at frame = sequence.");
  }

  [[noreturn]] static void throw_empty_truth(const PointCounts& points) {
    throw DataError("nothing to score against: of " +
                    grouped_text(static_cast<std::uint64_t>(points.out_of_range + points.ignored +
                                                            points.cropped)) +
                    " points " + std::to_string(points.out_of_range) + " are out of range, " +
                    std::to_string(points.ignored) + " have ignored labels and " +
                    std::to_string(points.cropped) +
                    " lie too near to the sensor; expected at least one that is left. Check "
                    "range_m, the label rule and minimum_horizontal_range.");
  }

  [[nodiscard]] LabelledVoxels estimate_map(const EvaluationInput& input, const ErasorTruth& truth,
                                            const LabelClasses& classes, const MaskStore& masks,
                                            PointCounts& points) const {
    const DenseMap dense = accumulate(input, options_, classes, &masks, "estimated map");
    points = dense.points;
    LabelledVoxels map = voxelise(dense.cloud, options_.voxel_size, classes, input.threads);
    map.mixed_label_ties += dense.mixed_label_ties;
    if (truth.dense) map.cloud.labels = truth.dense->labels_of(map.cloud.points, input.threads);
    return map;
  }

  /// The voxelised cloud, each voxel with the label of its nearest point in the dense map. Points
  /// of ignored labels stand in that map too, and what lies nearest to one is ignored likewise.
  [[nodiscard]] LabelledVoxels cloud_map(const EvaluationInput& input, const LabelClasses& classes,
                                         const std::vector<Eigen::Vector3f>& points) const {
    LabelledCloud cloud;
    for (const Eigen::Vector3f& point : points) cloud.points.push_back(point.cast<double>());
    cloud.labels.resize(points.size());
    const LabelledVoxels all = voxelise(cloud, options_.voxel_size, classes, input.threads);
    if (all.size() == 0) return all;
    EvaluationInput whole = input;
    whole.label_rule.ignored.clear();
    const LabelClasses whole_classes(effective_rule(whole.label_rule, options_));
    const NearestLabels dense(
        accumulate(whole, options_, whole_classes, nullptr, "points for labels").cloud);
    const std::vector<std::uint32_t> labels = dense.labels_of(all.cloud.points, input.threads);
    LabelledVoxels map;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (classes.of(labels[i]) == LabelClass::kIgnored) continue;
      map.keys.push_back(all.keys[i]);
      map.cloud.points.push_back(all.cloud.points[i]);
      map.cloud.labels.push_back(labels[i]);
    }
    return map;
  }

  [[nodiscard]] ProtocolResult result_of(const EvaluationInput& input, const ErasorTruth& truth,
                                         const LabelledVoxels& estimate,
                                         const LabelClasses& classes,
                                         const PointCounts& points) const {
    const std::vector<std::uint32_t> partners =
        find_partners(truth.map, estimate, options_.voxel_size, options_.matching, input.threads);
    const Overlap overlap = overlap_of(estimate, truth.map, options_, input.threads);
    ProtocolResult result;
    result.protocol = name();
    const MatchCounts counts = count_matches(truth.map, estimate, partners, classes, options_);
    add_counts(counts, "", result);
    add_rates(counts, "", result.rates);
    add_map_counts(truth, estimate, overlap, points, result);
    add_no_truck(input, truth, estimate, partners, result);
    result.intervals =
        intervals_of(count_matches_by_scan(truth.map, estimate, partners, truth.scan_of_voxel,
                                           input.scans->size(), classes, options_));
    add_warnings(estimate, overlap, result);
    return result;
  }

  static void add_map_counts(const ErasorTruth& truth, const LabelledVoxels& estimate,
                             const Overlap& overlap, const PointCounts& points,
                             ProtocolResult& result) {
    const auto unlabelled =
        std::count_if(truth.map.cloud.labels.begin(), truth.map.cloud.labels.end(),
                      [](std::uint32_t word) { return semantic_id(word) <= 1; });
    result.counts.insert(result.counts.end(),
                         {{"estimate_voxels", static_cast<std::int64_t>(estimate.size())},
                          {"estimate_voxels_without_partner", overlap.without_partner},
                          {"mixed_label_ties", truth.map.mixed_label_ties},
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
  void add_no_truck(const EvaluationInput& input, const ErasorTruth& truth,
                    const LabelledVoxels& estimate, const std::vector<std::uint32_t>& partners,
                    ProtocolResult& result) const {
    Options without = options_;
    without.truck_is_moving = false;
    const LabelRule with_trucks = effective_rule(input.label_rule, options_);
    const LabelRule without_trucks = effective_rule(input.label_rule, without);
    if (truth.points.trucks == 0 || with_trucks.moving == without_trucks.moving) return;
    const MatchCounts counts =
        count_matches(truth.map, estimate, partners, LabelClasses(without_trucks), without);
    add_counts(counts, "_no_truck", result);
    add_rates(counts, "_no_truck", result.rates);
  }

  void add_warnings(const LabelledVoxels& estimate, const Overlap& overlap,
                    ProtocolResult& result) const {
    if (estimate.size() == 0) {
      result.warnings.push_back("the estimate is empty: the method removed every evaluated point");
      return;
    }
    if (2 * overlap.near < static_cast<std::int64_t>(estimate.size())) {
      result.warnings.push_back(
          "more than half of the estimate's voxels lie over " +
          number_text(0.5 * options_.voxel_size) +
          " m from the ground truth; are both in the same frame, made from the same scans?");
    }
  }

  Options options_;
};

}  // namespace

ProtocolEntry erasor_protocol_entry() {
  return {"erasor",
          "Preservation and rejection rate over labelled map voxels (ERASOR paper): PR, RR, F1.",
          option_table().specs()};
}

std::unique_ptr<Protocol> make_erasor_protocol(const Configuration& options) {
  return std::make_unique<ErasorProtocol>(option_table().read(options));
}

}  // namespace raymoval
