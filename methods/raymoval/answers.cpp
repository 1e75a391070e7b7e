// SPDX-License-Identifier: MIT
#include "methods/raymoval/answers.h"

#include "methods/common/scan_passes.h"
#include "methods/common/workspaces.h"
#include "methods/raymoval/scan_against_map.h"

namespace raymoval::raymoval_method {
namespace {

// Codes of `answer_reasons`.
constexpr std::uint8_t kNeverContradicted = 0;
constexpr std::uint8_t kSeenThrough = 1;
constexpr std::uint8_t kInFrontOfMap = 2;
constexpr std::uint8_t kRestored = 3;

std::vector<std::string> answer_reasons() {
  return {"no scan contradicts its voxel, which stays in the map", "a scan saw through its voxel",
          "it stands in front of the map (eq. 11)",
          "it was a candidate, and validation found that it belongs to the static map"};
}

/// Why each point of a scan is kept or removed, see `answer_reasons`.
/// @param by_erasure whether being seen through makes a point a candidate
std::vector<std::uint8_t> reasons_for(const Mask& candidates, const Mask& dynamic,
                                      const std::vector<VoxelState>& states, bool by_erasure) {
  std::vector<std::uint8_t> codes(states.size(), kNeverContradicted);
  for (std::size_t k = 0; k < codes.size(); ++k) {
    if (candidates[k] == 0) continue;
    const bool erased = by_erasure && states[k] == VoxelState::kErased;
    codes[k] = dynamic[k] == 0 ? kRestored : erased ? kSeenThrough : kInFrontOfMap;
  }
  return codes;
}

Mask candidates_of(ScanAgainstMap& test, Scan scan, StaticMap& map, MapSource source,
                   const RunContext& context) {
  if (source != MapSource::kPrior) return test.find_off_map(std::move(scan), map, context);
  test.project_scan(std::move(scan), context);          // eqs 1-3, 10
  test.cast_first_hits(map.occupied(), context);        // eqs 4-7
  test.find_references(map, context, Tests::kForward);  // eqs 8-9
  return test.find_candidates(context);                 // eq. 11
}

}  // namespace

void answer_from_map(StaticMap& map, const Parameters& parameters, const ScanSource& scans,
                     RemovalSink& sink, const RunContext& context) {
  if (context.reasons != nullptr) context.reasons->explain(answer_reasons());
  map.occupied().update_boxes(context.threads);  // From here on the map is only read.
  RunContext of_scan = context;
  of_scan.threads = 1;
  if (context.threads > 1) of_scan.times = nullptr;
  Workspaces<ScanAgainstMap> workspaces(
      [&] { return std::make_unique<ScanAgainstMap>(parameters, scans.sensor()); });
  const bool by_erasure = parameters.map_source != MapSource::kPrior || parameters.erased_points;
  const auto answer_scan = [&](Scan& scan) {
    const std::size_t index = scan.index;
    workspaces.with_one([&](ScanAgainstMap& test) {
      const Mask candidates =
          candidates_of(test, std::move(scan), map, parameters.map_source, of_scan);
      Mask dynamic;
      {
        const StageScope timed(parameters.validate ? of_scan.times : nullptr, "validation");
        dynamic = test.validate(candidates, map.occupied());  // eqs 12-15
      }
      sink.accept(index, dynamic);
      if (context.reasons == nullptr) return;
      context.reasons->accept(
          index, reasons_for(candidates, dynamic, test.voxels().of_points(test.known().states),
                             by_erasure));
    });
  };
  for_scans_at_once("raymoval, answers", "answer and validation", scans, context, answer_scan);
}

}  // namespace raymoval::raymoval_method
