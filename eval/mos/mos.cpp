// SPDX-License-Identifier: MIT
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"
#include "eval/built_in_protocols.h"
#include "eval/checked_scan.h"
#include "eval/points/cloud_masks.h"
#include "eval/points/labelled_voxels.h"
#include "eval/points/scan_loops.h"

namespace raymoval {
namespace {

struct Options {
  bool ignore_unlabelled = true;
};

const ParameterTable<Options>& option_table() {
  static const ParameterTable<Options> table = [] {
    ParameterTable<Options> made;
    made.flag("ignore_unlabelled", &Options::ignore_unlabelled,
              {.source = "semantic-kitti-api, configuration for moving objects",
               .sentence = "Points of label 0 (unlabelled) or 1 (outlier) are on neither side; not "
                           "where the label rule lets 0 or 1 move."});
    return made;
  }();
  return table;
}

/// The points of a scan by class and by mask.
struct Confusion {
  std::int64_t static_points = 0, dynamic_points = 0;
  std::int64_t kept_static = 0, flagged_dynamic = 0;
  std::int64_t out_of_range = 0, ignored = 0;

  Confusion& operator+=(const Confusion& other) {
    static_points += other.static_points;
    dynamic_points += other.dynamic_points;
    kept_static += other.kept_static;
    flagged_dynamic += other.flagged_dynamic;
    out_of_range += other.out_of_range;
    ignored += other.ignored;
    return *this;
  }
};

/// The counts of the rates, and their names.
constexpr const char* kCounts[] = {"flagged_dynamic_points", "dynamic_points", "kept_static_points",
                                   "static_points"};
std::vector<std::int64_t> counts_of(const Confusion& points) {
  return {points.flagged_dynamic, points.dynamic_points, points.kept_static, points.static_points};
}

CountsByScan counts_by_scan(const std::vector<std::vector<std::int64_t>>& scans) {
  CountsByScan counts;
  for (std::size_t i = 0; i < std::size(kCounts); ++i) {
    auto& of_scans = counts.emplace_back(kCounts[i], std::vector<std::int64_t>()).second;
    for (const std::vector<std::int64_t>& scan : scans) of_scans.push_back(scan[i]);
  }
  return counts;
}

std::vector<Rate> segmentation_rates(const std::vector<std::int64_t>& counts) {
  const std::int64_t true_positive = counts[0], moving = counts[1];
  const std::int64_t false_positive = counts[3] - counts[2];
  const std::string no_moving = "the ground truth has no moving point";
  const std::int64_t either = moving == 0 ? 0 : moving + false_positive;
  return {percent_rate("precision", true_positive, true_positive + false_positive,
                       "no point is removed"),
          percent_rate("recall", true_positive, moving, no_moving),
          percent_rate("IoU", true_positive, either, no_moving)};
}

ProtocolResult result_of(const std::vector<Confusion>& scans) {
  Confusion all;
  std::vector<std::vector<std::int64_t>> by_scan;
  for (const Confusion& scan : scans) {
    all += scan;
    by_scan.push_back(counts_of(scan));
  }
  ProtocolResult result;
  result.protocol = "mos";
  result.counts = {
      {"static_points", all.static_points},      {"dynamic_points", all.dynamic_points},
      {"kept_static_points", all.kept_static},   {"flagged_dynamic_points", all.flagged_dynamic},
      {"out_of_range_points", all.out_of_range}, {"ignored_points", all.ignored}};
  result.rates = segmentation_rates(counts_of(all));
  result.intervals = bootstrap(by_scan, segmentation_rates);
  result.by_scan = counts_by_scan(by_scan);
  return result;
}

class MosScorer : public Scorer {
 public:
  MosScorer(const EvaluationInput& evaluated, const Options& options)
      : Scorer(evaluated), classes_(input().label_rule) {
    ignores_unlabelled_ = options.ignore_unlabelled && !classes_.moving(0) && !classes_.moving(1);
    check_not_empty();
  }

  [[nodiscard]] std::unique_ptr<Scoring> start() const override {
    return std::make_unique<MosScoring>(*this);
  }

  [[nodiscard]] ProtocolResult score_cloud(const CloudEstimate& cloud) const override {
    return score(cloud.masks(input(), kCloudDistance));
  }

 private:
  class MosScoring : public Scoring {
   public:
    explicit MosScoring(const MosScorer& scorer) : scorer_(scorer) {}

    bool begin_pass(std::size_t slots) override {
      slots_.resize(slots);
      return ++pass_ == 1;
    }
    void read(const CheckedScan& scan, std::size_t slot) override {
      slots_[slot] = scorer_.confusion_of(scan);
    }
    void take(std::size_t slot) override { scans_.push_back(slots_[slot]); }
    ProtocolResult result() override { return result_of(scans_); }

   private:
    const MosScorer& scorer_;
    int pass_ = 0;
    std::vector<Confusion> slots_;
    std::vector<Confusion> scans_;  ///< In order.
  };

  [[nodiscard]] LabelClass class_of(std::uint32_t word) const {
    return ignores_unlabelled_ && semantic_id(word) <= 1 ? LabelClass::kIgnored : classes_.of(word);
  }

  [[nodiscard]] Confusion confusion_of(const CheckedScan& loaded) const {
    Confusion found;
    for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
      if (!input().range_m.contains(loaded.scan.points[i].cast<double>().norm())) {
        ++found.out_of_range;
        continue;
      }
      const bool removed = loaded.removed(i);
      switch (class_of(loaded.labels[i])) {
        case LabelClass::kIgnored:
          ++found.ignored;
          break;
        case LabelClass::kStatic:
          ++found.static_points;
          found.kept_static += removed ? 0 : 1;
          break;
        case LabelClass::kMoving:
          ++found.dynamic_points;
          found.flagged_dynamic += removed ? 1 : 0;
          break;
      }
    }
    return found;
  }

  void check_not_empty() const {
    std::vector<Confusion> scans(input().scans->size());
    for_each_scan(input(), "ground truth points", [&](std::size_t i) {
      scans[i] = confusion_of(load_checked(input(), nullptr, i));
    });
    Confusion all;
    for (const Confusion& scan : scans) all += scan;
    if (all.static_points + all.dynamic_points > 0) return;
    throw DataError("nothing to score against: " + std::to_string(all.out_of_range) +
                    " points are out of range and " + std::to_string(all.ignored) +
                    " have ignored labels; expected at least one that is left. Check range_m, the "
                    "label rule and protocol:mos.ignore_unlabelled.");
  }

  LabelClasses classes_;
  bool ignores_unlabelled_ = false;
};

std::vector<RateSpec> mos_rates() {
  return {{.name = "precision",
           .role = RateRole::kKept,
           .moving_points_removed = 100.0,
           .note = "precision, recall and IoU are those of the moving class, point by point in "
                   "each scan."},
          {.name = "recall",
           .role = RateRole::kRemoved,
           .nothing_removed = 0.0,
           .everything_removed = 100.0,
           .moving_points_removed = 100.0},
          {.name = "IoU",
           .role = RateRole::kHeadline,
           .nothing_removed = 0.0,
           .moving_points_removed = 100.0}};
}

}  // namespace

/// Moving-object segmentation, point by point in each scan, as semantic-kitti-api's evaluate_mos
/// counts it: the intersection over union of the moving class, its precision and its recall.
///
/// A removed point is predicted as moving. With TP the removed moving points, FP the removed static
/// points, and FN the kept moving points,
/// IoU = 100 TP / (TP + FP + FN), precision = 100 TP / (TP + FP), recall = 100 TP / (TP + FN), of
/// the sums over all scans. Points of an ignored label are on neither side. With
/// `ignore_unlabelled`, neither are points of label 0 (unlabelled) and 1 (outlier), unless these
/// labels move by the label rule. The rates do not depend on poses, voxels, or other points.
/// A cleaned cloud keeps the points that lie within 0.05 m of it.
///
/// Counts: static_points, dynamic_points, kept_static_points, flagged_dynamic_points,
/// out_of_range_points, ignored_points. IoU and recall are undefined without a moving point (the
/// public code gives 0), precision if no point is removed. Intervals come from a block bootstrap
/// over scans.
ProtocolEntry mos_protocol_entry() {
  return {.name = "mos",
          .version = "1",
          .sentence =
              "Moving-object segmentation, point by point in each scan: precision, recall and "
              "intersection over union of the moving class.",
          .bibtex = R"(@article{chen2021moving,
  author = {Chen, Xieyuanli and Li, Shijie and Mersch, Benedikt and Wiesmann, Louis and Gall,
    J{\"u}rgen and Behley, Jens and Stachniss, Cyrill},
  title = {Moving Object Segmentation in 3D LiDAR Data: A Learning-Based Approach Exploiting
    Sequential Data},
  journal = {IEEE Robotics and Automation Letters},
  year = {2021},
  volume = {6},
  number = {4},
  pages = {6529--6536},
  doi = {10.1109/LRA.2021.3093567}
}
)",
          .parameters = option_table().specs(),
          .rates = mos_rates(),
          .counts = {{"static_points", true},
                     {"dynamic_points", true},
                     {"kept_static_points"},
                     {"flagged_dynamic_points"},
                     {"out_of_range_points", true},
                     {"ignored_points", true}},
          .open = [](const EvaluationInput& input,
                     const Configuration& options) -> std::unique_ptr<Scorer> {
            return std::make_unique<MosScorer>(input, option_table().read(options));
          }};
}

}  // namespace raymoval
