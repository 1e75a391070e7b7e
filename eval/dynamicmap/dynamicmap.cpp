// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/dynamicmap.h"

#include "eval/dynamicmap/accuracy.h"
#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/presence.h"
#include "eval/points/cloud_masks.h"

namespace raymoval {
namespace {

using namespace dynamicmap;

/// What the rates are made of.
std::vector<std::int64_t> counts_of(const ScanPresence& presence) {
  return {presence.present_static, presence.points.static_points, presence.removed_dynamic,
          presence.points.dynamic_points};
}

std::vector<Rate> rates_of(const std::vector<std::int64_t>& counts) {
  return accuracy_rates(counts[0], counts[1], counts[2], counts[3], "point");
}

class DynamicMapScorer : public Scorer {
 public:
  DynamicMapScorer(const EvaluationInput& input, const Options& options)
      : input_(input),
        options_(options),
        truth_(input_, options_.maximum_range, options_.ego_range) {
    (void)truth_.count("ground truth points");  // Throws if there is nothing to score against.
  }

  [[nodiscard]] ProtocolResult score(const MaskStore& masks) const override {
    check_mask_count(input_, masks);
    return result_of(measure_presence(truth_, masks, options_));
  }

  [[nodiscard]] ProtocolResult score_cloud(const CloudEstimate& cloud) const override {
    return result_of(presence_by_index(truth_, cloud.masks(input_, options_.distance)));
  }

 private:
  [[nodiscard]] static ProtocolResult result_of(const std::vector<ScanPresence>& scans) {
    ScanPresence all;
    for (const ScanPresence& scan : scans) all += scan;
    ProtocolResult result;
    result.protocol = "dynamicmap";
    result.counts = {{"static_points", all.points.static_points},
                     {"dynamic_points", all.points.dynamic_points},
                     {"present_static_points", all.present_static},
                     {"removed_dynamic_points", all.removed_dynamic},
                     {"kept_static_points", all.kept_static},
                     {"flagged_dynamic_points", all.flagged_dynamic},
                     {"ego_points", all.points.ego},
                     {"out_of_range_points", all.points.out_of_range},
                     {"ignored_points", all.points.ignored}};
    result.rates = rates_of(counts_of(all));
    std::vector<std::vector<std::int64_t>> by_scan;
    for (const ScanPresence& scan : scans) by_scan.push_back(counts_of(scan));
    result.intervals = bootstrap(by_scan, rates_of);
    if (all.kept_static == 0 && all.flagged_dynamic == all.points.dynamic_points) {
      result.warnings.push_back("the estimate is empty: every evaluated point is removed");
    }
    return result;
  }

  EvaluationInput input_;
  Options options_;
  TruthPoints truth_;
};

}  // namespace

ProtocolEntry dynamicmap_protocol_entry() {
  return {.name = "dynamicmap",
          .version = "1",
          .sentence =
              "Static and dynamic accuracy over points (KTH DynamicMap benchmark): SA, DA, "
              "AA, HA.",
          .parameters = option_table().specs(),
          .rates = accuracy_rate_list(),
          .counts = {{"static_points", true},
                     {"dynamic_points", true},
                     {"present_static_points"},
                     {"removed_dynamic_points"},
                     {"kept_static_points"},
                     {"flagged_dynamic_points"},
                     {"ego_points", true},
                     {"out_of_range_points", true},
                     {"ignored_points", true}},
          .open = [](const EvaluationInput& input,
                     const Configuration& options) -> std::unique_ptr<Scorer> {
            return std::make_unique<DynamicMapScorer>(input, option_table().read(options));
          }};
}

}  // namespace raymoval
