// SPDX-License-Identifier: MIT
#include "methods/erasor/scan_ratio_test.h"

#include <algorithm>

namespace raymoval::erasor_method {

BinFinding compare_extents(const BinExtent& map, const BinExtent& query,
                           const Parameters& parameters) {
  if (query.points < parameters.minimum_points) return BinFinding::kTooFewPoints;
  if (map.points == 0) return BinFinding::kQueryOnly;
  const double of_map = map.extent(), of_query = query.extent();
  const double ratio = std::min(of_map, of_query) / std::max(of_map, of_query);
  // The ratio of two zeros is not a number, which is not less than anything.
  if (!(ratio < parameters.ratio_threshold)) return BinFinding::kEqual;
  return of_map >= of_query ? BinFinding::kMapHigher : BinFinding::kCurrentHigher;
}

BinAction action_for(BinFinding finding, const BinExtent& map, const Parameters& parameters) {
  BinAction action;
  if (finding == BinFinding::kMapHigher) {
    action.remove = parameters.version == 3 ? map.extent() > parameters.minimum_object_height
                                            : map.highest > parameters.minimum_top;
    action.reinsert = action.remove;
  } else if (parameters.version == 2) {
    action.reinsert = finding == BinFinding::kEqual || finding == BinFinding::kQueryOnly;
  }
  action.reinsert = action.reinsert && parameters.reinsert;
  return action;
}

}  // namespace raymoval::erasor_method
