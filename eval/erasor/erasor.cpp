// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/erasor_paper.h"
#include "core/error.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/built_in_protocols.h"
#include "eval/erasor/maps/accumulate.h"
#include "eval/erasor/maps/estimate_map.h"
#include "eval/erasor/matching.h"
#include "eval/erasor/options.h"
#include "eval/points/cloud_masks.h"
#include "eval/points/nearest_points.h"

namespace raymoval::erasor {
namespace {

/// Suffix of the names of counts and rates with trucks counted as static.
constexpr const char* kNoTruck = "_no_truck";

/// PR, RR and F1, then the same with trucks counted as static.
std::vector<RateSpec> rate_list() {
  const RateFormula f1{"PR", "RR", "harmonic_mean", f1_from_percent, true};
  // The oracle's loss of static voxels beside moving voxels depends on the data.
  std::vector<RateSpec> rates = {
      {.name = "PR", .role = RateRole::kKept, .nothing_removed = 100.0, .everything_removed = 0.0},
      {.name = "RR",
       .role = RateRole::kRemoved,
       .nothing_removed = 0.0,
       .everything_removed = 100.0,
       .moving_points_removed = 100.0},
      {.name = "F1",
       .unit = RateUnit::kFraction,
       .decimals = 4,
       .role = RateRole::kHeadline,
       .formula = f1}};
  for (std::size_t i = 0; i < 3; ++i) {
    rates.push_back(
        {.name = rates[i].name + kNoTruck, .unit = rates[i].unit, .decimals = rates[i].decimals});
  }
  return rates;
}

/// All counts that a result may have.
std::vector<CountSpec> count_list() {
  std::vector<CountSpec> counts;
  for (const std::string suffix : {"", kNoTruck}) {
    counts.insert(counts.end(), {{"static_voxels" + suffix, true},
                                 {"dynamic_voxels" + suffix, true},
                                 {"preserved_static" + suffix},
                                 {"remaining_dynamic" + suffix}});
  }
  counts.insert(counts.end(), {{"estimate_voxels"},
                               {"estimate_voxels_without_partner"},
                               {"mixed_label_ties", true},
                               {"estimate_mixed_label_ties"},
                               {"unlabelled_voxels", true},
                               {"evaluated_points", true},
                               {"removed_points"},
                               {"out_of_range_points", true},
                               {"ignored_points", true},
                               {"cropped_points", true},
                               {"cloud_points"}});
  return counts;
}

/// PR, RR and F1 of `counts`. @param suffix of their names
std::vector<Rate> rates_of(const MatchCounts& counts, const std::string& suffix = "") {
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
  return {preservation, rejection, f1};
}

/// Adds `counts` and their rates to a result.
void add_matches(const MatchCounts& counts, const std::string& suffix, ProtocolResult& result) {
  result.counts.emplace_back("static_voxels" + suffix, counts.static_voxels);
  result.counts.emplace_back("dynamic_voxels" + suffix, counts.dynamic_voxels);
  result.counts.emplace_back("preserved_static" + suffix, counts.preserved_static);
  result.counts.emplace_back("remaining_dynamic" + suffix, counts.remaining_dynamic);
  for (Rate& rate : rates_of(counts, suffix)) result.rates.push_back(std::move(rate));
}

/// Intervals of PR, RR and F1. @param scans the counts of each scan, in order
Intervals intervals_of(const std::vector<MatchCounts>& scans) {
  std::vector<std::vector<std::int64_t>> counts;
  for (const MatchCounts& scan : scans) {
    counts.push_back(
        {scan.static_voxels, scan.dynamic_voxels, scan.preserved_static, scan.remaining_dynamic});
  }
  return bootstrap(counts, [](const std::vector<std::int64_t>& sums) {
    return rates_of({sums[0], sums[1], sums[2], sums[3]});
  });
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
  ErasorScorer(const EvaluationInput& evaluated, const Options& options)
      : Scorer(evaluated),
        options_(options),
        classes_(effective_rule(evaluated.label_rule, options)),
        truth_(rules()) {
    if (truth_.voxels() == 0) throw_empty_truth(truth_.points());
    if (options_.label_mode == LabelMode::kNearest) {
      dense_ = std::make_unique<NearestLabels>(dense_map(rules(), "points for labels"));
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
          "a cloud is in the frame of the sequence's poses: expected frame = sequence.");
    }
    ProtocolResult result =
        result_of(ListedVoxels(cloud_map(cloud.points()), classes_), truth_.points(), 0);
    std::erase_if(result.counts, [](const auto& count) { return count.first == "removed_points"; });
    result.counts.emplace_back("cloud_points", static_cast<std::int64_t>(cloud.points().size()));
    return result;
  }

 private:
  class ErasorScoring : public Scoring {
   public:
    explicit ErasorScoring(const ErasorScorer& scorer)
        : scorer_(scorer), map_(std::in_place, scorer.rules(), scorer.truth_) {}

    bool begin_pass(std::size_t slots) override {
      if (map_->begin_pass(slots)) return true;
      result_ = scorer_.result_of_masks(*map_);
      map_.reset();  // Others may need the memory for their passes.
      return false;
    }
    void read(const CheckedScan& scan, std::size_t slot) override { map_->read(scan, slot); }
    void take(std::size_t slot) override { map_->take(slot); }
    ProtocolResult result() override { return std::move(result_); }

   private:
    const ErasorScorer& scorer_;
    std::optional<EstimateMap> map_;  ///< Until the last pass.
    ProtocolResult result_;
  };

  [[nodiscard]] MapRules rules() const { return {input(), options_, classes_}; }

  [[nodiscard]] ProtocolResult result_of_masks(const EstimateMap& map) const {
    const std::int64_t ties = map.mixed_label_ties();
    if (!dense_) return result_of(map, map.points(), ties);
    return result_of(relabelled(map), map.points(), ties);
  }

  /// A map with labels from the nearest point of the dense map.
  [[nodiscard]] ListedVoxels relabelled(const EstimateMap& map) const {
    LabelledVoxels voxels;
    map.cells().for_each([&](CellLattice::Number number, VoxelKey cell) {
      if (!is_voxel(map.mean(number))) return;
      voxels.keys.push_back(cell);
      voxels.cloud.points.push_back(map.mean(number));
    });
    voxels.cloud.labels = dense_->labels_of(voxels.cloud.points, input().threads);
    return {voxels, classes_};
  }

  /// The voxelised cloud, each voxel with the label of its nearest point in the dense map. That map
  /// includes points of ignored labels; a voxel nearest to such a point is ignored too.
  [[nodiscard]] LabelledVoxels cloud_map(const std::vector<Eigen::Vector3f>& points) const {
    LabelledCloud cloud;
    for (const Eigen::Vector3f& point : points) cloud.points.push_back(point.cast<double>());
    cloud.labels.resize(points.size());
    const LabelledVoxels all = voxelise(cloud, options_.voxel_size, classes_, input().threads);
    if (all.size() == 0) return all;
    EvaluationInput whole = input();
    whole.label_rule.ignored.clear();
    const LabelClasses whole_classes(effective_rule(whole.label_rule, options_));
    const NearestLabels dense(dense_map({whole, options_, whole_classes}, "points for labels"));
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

  /// @param points counts of the points of the estimate
  /// @param ties mixed-label ties of the estimate
  [[nodiscard]] ProtocolResult result_of(const MapVoxels& estimate, const PointCounts& points,
                                         std::int64_t ties) const {
    const std::vector<VoxelKind> partners =
        partner_kinds(truth_, estimate, options_, input().threads);
    const Overlap overlap = overlap_of(estimate, truth_, options_, input().threads);
    const CountingRule rule{options_.label_rule, options_.ignore_0_1, true};
    ProtocolResult result;
    result.protocol = "erasor";
    add_matches(count_matches(truth_, partners, rule), "", result);
    add_map_counts(overlap, points, ties, result);
    add_no_truck(partners, rule, result);
    result.intervals =
        intervals_of(count_matches_by_scan(truth_, partners, input().scans->size(), rule));
    add_warnings(overlap, result);
    return result;
  }

  void add_map_counts(const Overlap& overlap, const PointCounts& points, std::int64_t ties,
                      ProtocolResult& result) const {
    result.counts.insert(result.counts.end(),
                         {{"estimate_voxels", overlap.voxels},
                          {"estimate_voxels_without_partner", overlap.without_partner},
                          {"mixed_label_ties", truth_.mixed_label_ties()},
                          {"estimate_mixed_label_ties", ties},
                          {"unlabelled_voxels", truth_.unlabelled_voxels()},
                          {"evaluated_points", points.evaluated},
                          {"removed_points", points.removed},
                          {"out_of_range_points", points.out_of_range},
                          {"ignored_points", points.ignored},
                          {"cropped_points", points.cropped}});
  }

  /// The same voxels with trucks counted as static. Voxels store labels, not classes, so the maps
  /// and the partners do not change.
  void add_no_truck(const std::vector<VoxelKind>& partners, CountingRule rule,
                    ProtocolResult& result) const {
    if (truth_.points().trucks == 0 || !classes_.moving(kMovingTruck)) return;
    rule.trucks_move = false;
    add_matches(count_matches(truth_, partners, rule), kNoTruck, result);
  }

  void add_warnings(const Overlap& overlap, ProtocolResult& result) const {
    if (overlap.voxels == 0) {
      result.warnings.push_back("the estimate is empty: the method removed every evaluated point");
    } else if (2 * overlap.near < overlap.voxels) {
      result.warnings.push_back(
          "more than half of the estimate's voxels lie over " +
          number_text(0.5 * options_.voxel_size) +
          " m from the ground truth; are both in the same frame, made from the same scans?");
    }
  }

  Options options_;
  LabelClasses classes_;
  TruthMap truth_;
  /// The searchable dense map; only kept if it gives the labels of the estimate.
  std::unique_ptr<NearestLabels> dense_;
};

}  // namespace
}  // namespace raymoval::erasor

namespace raymoval {
namespace {

std::unique_ptr<Scorer> open_erasor(const EvaluationInput& input, const Configuration& options) {
  return std::make_unique<erasor::ErasorScorer>(input, erasor::option_table().read(options));
}

bool frame_needs_calibration(const Configuration& options) {
  return erasor::option_table().read(options).frame == erasor::FrameOption::kErasor;
}

/// Whether labels are assigned by nearest neighbour or ignored. Then a static point may replace a
/// removed point.
bool labels_are_uncertain(const Configuration& configuration) {
  const erasor::Options options = erasor::option_table().read(configuration);
  return options.label_mode == erasor::LabelMode::kNearest ||
         options.label_rule == erasor::LabelRuleOption::kGeometry;
}

}  // namespace

/// The protocol of the ERASOR paper, which most papers of the field use: PR, RR and F1 over voxels
/// of the map.
///
/// Truth: all points, cropped, lifted, posed, voxelised scan by scan and once more as a whole, one
/// label per voxel. Estimate: the same of the points that a method kept. Each truth voxel looks for
/// its nearest estimate voxel within half a voxel's diagonal; a static one is preserved if that is
/// static, a moving one remains if that moves. PR = preserved / static, RR = 1 - remaining /
/// moving (percent), F1 their harmonic mean (fraction).
///
/// The intervals of PR, RR and F1 come from a block bootstrap over scans. For this each voxel of
/// the truth belongs to one scan: the scan of the point that gave the voxel its label, which is the
/// point nearest to the centroid. So each voxel counts once, the voxels that several scans saw
/// spread over these scans, and the counts of all scans add up to those of the map.
///
/// Counts: static_voxels, dynamic_voxels, preserved_static, remaining_dynamic; estimate_voxels;
/// estimate_voxels_without_partner (no truth voxel within the same reach; never penalised);
/// mixed_label_ties and estimate_mixed_label_ties (voxels whose class depended on input order);
/// unlabelled_voxels (truth voxels labelled 0 or 1); evaluated_points and removed_points
/// (those of them that were flagged); out_of_range_points, ignored_points, cropped_points. If
/// moving trucks (id 258) occur and move, the first four and the rates come again as `..._no_truck`
/// with trucks counted as static, as in the scripts behind early published tables.
///
/// A cleaned cloud (with `label_mode` nearest, and `lift` 0 unless the cloud was lifted, too)
/// is voxelised once; each voxel takes the label of the nearest point of the dense map, however far
/// away. Static voxels beside removed objects so become dynamic and RR has a ceiling below 100:
/// the score of the oracle's cloud shows it. `cloud_points` then replaces `removed_points`.
ProtocolEntry erasor_protocol_entry() {
  return {.name = "erasor",
          .version = "1",
          .sentence =
              "Preservation and rejection rate over labelled map voxels (ERASOR paper): "
              "PR, RR, F1.",
          .bibtex = kErasorBibtex,
          .parameters = erasor::option_table().specs(),
          .rates = erasor::rate_list(),
          .counts = erasor::count_list(),
          .open = open_erasor,
          .cloud_options = {{"label_mode", std::string("nearest")}, {"lift", 0.0}},
          .reads_calibration = frame_needs_calibration,
          .oracle_is_uncertain = labels_are_uncertain};
}

}  // namespace raymoval
