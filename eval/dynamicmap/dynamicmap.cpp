// SPDX-License-Identifier: MIT
#include "eval/built_in_protocols.h"
#include "eval/dynamicmap/accuracy.h"
#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/presence.h"
#include "eval/points/cloud_masks.h"

namespace raymoval {
namespace {

using namespace dynamicmap;

std::vector<CountSpec> point_count_list() {
  return {{"static_points", true},    {"dynamic_points", true},      {"present_static_points"},
          {"removed_dynamic_points"}, {"kept_static_points"},        {"flagged_dynamic_points"},
          {"ego_points", true},       {"out_of_range_points", true}, {"ignored_points", true}};
}

/// The counts of the rates.
std::vector<std::int64_t> counts_of(const ScanPresence& presence) {
  return {presence.present_static, presence.points.static_points, presence.removed_dynamic,
          presence.points.dynamic_points};
}

std::vector<Rate> rates_of(const std::vector<std::int64_t>& counts) {
  return accuracy_rates(counts[0], counts[1], counts[2], counts[3], "point");
}

ProtocolResult result_of(const std::vector<ScanPresence>& scans) {
  ScanPresence all;
  for (const ScanPresence& scan : scans) all += scan;
  ProtocolResult result;
  result.protocol = "dynamicmap";
  result.counts = named_counts(
      point_count_list(), {all.points.static_points, all.points.dynamic_points, all.present_static,
                           all.removed_dynamic, all.kept_static, all.flagged_dynamic,
                           all.points.ego, all.points.out_of_range, all.points.ignored});
  result.rates = rates_of(counts_of(all));
  std::vector<std::vector<std::int64_t>> by_scan;
  for (const ScanPresence& scan : scans) by_scan.push_back(counts_of(scan));
  result.intervals = bootstrap(by_scan, rates_of);
  if (all.kept_static == 0 && all.flagged_dynamic == all.points.dynamic_points) {
    result.warnings.push_back("the estimate is empty: every evaluated point is removed");
  }
  return result;
}

class DynamicMapScoring : public Scoring {
 public:
  explicit DynamicMapScoring(const PresenceCount::Input& input)
      : presence_(PresenceCount::start(input, {})) {}

  [[nodiscard]] bool runs_last() const override { return presence_->runs_last(); }
  bool begin_pass(std::size_t slots) override { return presence_->begin_pass(slots); }
  void read(const CheckedScan& scan, std::size_t slot) override { presence_->read(scan, slot); }
  void take(std::size_t slot) override { presence_->take(slot); }
  ProtocolResult result() override { return result_of(presence_->finish()); }

 private:
  std::unique_ptr<PresenceCount> presence_;
};

class DynamicMapScorer : public Scorer {
 public:
  DynamicMapScorer(const EvaluationInput& evaluated, const Options& options)
      : Scorer(evaluated),
        options_(options),
        truth_(input(), options_.maximum_range, options_.ego_range),
        grid_(options_.distance),
        blocks_(truth_blocks(truth_, grid_)) {}

  [[nodiscard]] std::unique_ptr<Scoring> start() const override {
    return std::make_unique<DynamicMapScoring>(
        PresenceCount::Input{truth_, options_, grid_, blocks_});
  }

  [[nodiscard]] ProtocolResult score_cloud(const CloudEstimate& cloud) const override {
    return result_of(presence_by_index(truth_, cloud.masks(input(), options_.distance)));
  }

 private:
  Options options_;
  TruthPoints truth_;
  FineGrid grid_;
  TruthBlocks blocks_;
};

}  // namespace

/// The protocol of the KTH DynamicMap benchmark: SA, DA, AA, HA over the points of all scans.
///
/// Truth: every point, where the poses put it, without voxels, crop or lift. A point is present if
/// any kept point, itself included, is at most `distance` away, else it is gone; labels of kept
/// points are ignored. SA = present static / static, DA = gone dynamic / dynamic (percent), AA =
/// sqrt(SA DA), HA = 2 SA DA / (SA + DA). Their intervals come from a block bootstrap over scans;
/// each point belongs to its scan. So a removed point that lies near a kept one counts as present,
/// and an oracle stays below DA 100 where wheels touch the road. Points of an ignored label are in
/// neither denominator, but a map made by a method holds them like any other
/// (`ignored_in_estimate`).
///
/// Counts: static_points, dynamic_points, present_static_points, removed_dynamic_points; by index,
/// directly from the masks: kept_static_points, flagged_dynamic_points; ego_points (among the
/// dynamic ones), out_of_range_points, ignored_points. Undefined without a static or a dynamic
/// point; an empty estimate scores SA 0 and DA 100 (the public code leaves it at 100 and 100).
///
/// @note Distances are computed in double from float32 sensor coordinates, not in float32 as by the
/// public code: a difference of rounding only, which does not depend on the distance of the origin.
ProtocolEntry dynamicmap_protocol_entry() {
  return {.name = "dynamicmap",
          .version = "1",
          .sentence =
              "Static and dynamic accuracy over points (KTH DynamicMap benchmark): SA, DA, "
              "AA, HA.",
          .bibtex = R"(@inproceedings{zhang2023benchmark,
  author = {Zhang, Qingwen and Duberg, Daniel and Geng, Ruoyu and Jia, Mingkai and Wang, Lujia
    and Jensfelt, Patric},
  title = {A Dynamic Points Removal Benchmark in Point Cloud Maps},
  booktitle = {IEEE International Conference on Intelligent Transportation Systems (ITSC)},
  year = {2023},
  pages = {608--614},
  doi = {10.1109/ITSC57777.2023.10422094}
}
)",
          .parameters = option_table().specs(),
          .rates = accuracy_rate_list(),
          .counts = point_count_list(),
          .open = [](const EvaluationInput& input,
                     const Configuration& options) -> std::unique_ptr<Scorer> {
            return std::make_unique<DynamicMapScorer>(input, option_table().read(options));
          }};
}

}  // namespace raymoval
