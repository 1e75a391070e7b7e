// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/dynamicmap.h"

#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/presence.h"
#include "eval/points/cloud_masks.h"

namespace raymoval {
namespace {

using namespace dynamicmap;

/// Nothing is prepared but the certainty that there is something to score against.
class DynamicMapTruth : public TruthMap {};

/// What the rates are made of.
std::vector<std::int64_t> counts_of(const ScanPresence& presence) {
  return {presence.present_static, presence.points.static_points, presence.removed_dynamic,
          presence.points.dynamic_points};
}

std::vector<Rate> rates_of(const std::vector<std::int64_t>& counts) {
  return accuracy_rates(counts[0], counts[1], counts[2], counts[3], "point");
}

class DynamicMapProtocol : public Protocol {
 public:
  explicit DynamicMapProtocol(const Options& options) : options_(options) {}
  [[nodiscard]] std::string name() const override { return "dynamicmap"; }
  [[nodiscard]] std::string version() const override { return "1"; }
  [[nodiscard]] Configuration options() const override { return option_table().write(options_); }

  [[nodiscard]] std::unique_ptr<TruthMap> prepare(const EvaluationInput& input) const override {
    check_input(input, name());
    (void)truth_points(input).count("ground truth points");
    return std::make_unique<DynamicMapTruth>();
  }

  [[nodiscard]] ProtocolResult score(const EvaluationInput& input, const TruthMap& /*truth*/,
                                     const MaskStore& masks) const override {
    check_input(input, name());
    check_mask_count(input, masks);
    return result_of(measure_presence(truth_points(input), masks, options_));
  }

  [[nodiscard]] ProtocolResult score_cloud(const EvaluationInput& input, const TruthMap& /*truth*/,
                                           const CloudEstimate& cloud) const override {
    check_input(input, name());
    const MaskStore& masks = cloud.masks(input, options_.distance);
    return result_of(presence_by_index(truth_points(input), masks));
  }

 private:
  [[nodiscard]] TruthPoints truth_points(const EvaluationInput& input) const {
    return {input, options_.maximum_range, options_.ego_range};
  }

  [[nodiscard]] ProtocolResult result_of(const std::vector<ScanPresence>& scans) const {
    ScanPresence all;
    for (const ScanPresence& scan : scans) all += scan;
    ProtocolResult result;
    result.protocol = name();
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

  Options options_;
};

}  // namespace

ProtocolEntry dynamicmap_protocol_entry() {
  return {"dynamicmap",
          "Static and dynamic accuracy over points (KTH DynamicMap benchmark): SA, DA, AA, HA.",
          option_table().specs()};
}

std::unique_ptr<Protocol> make_dynamicmap_protocol(const Configuration& options) {
  return std::make_unique<DynamicMapProtocol>(option_table().read(options));
}

}  // namespace raymoval
