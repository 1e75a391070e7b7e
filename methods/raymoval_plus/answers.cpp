// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/answers.h"

#include <algorithm>

#include "core/scan/mask_store.h"
#include "methods/common/prepared_scans.h"
#include "methods/common/workspaces.h"
#include "methods/raymoval_plus/objects/journeys.h"
#include "methods/raymoval_plus/objects/low_points.h"
#include "methods/raymoval_plus/objects/point_evidence.h"
#include "methods/raymoval_plus/objects/reasons.h"

namespace raymoval::raymoval_plus_method {
namespace {

Mask removed_points(const Verdicts& verdicts) {
  Mask removed(verdicts.size());
  for (std::size_t k = 0; k < removed.size(); ++k) {
    removed[k] = verdicts[k] == Verdict::kDynamic ? 1 : 0;
  }
  return removed;
}

/// Whether somebody asks for more of each point than whether it is removed.
bool asks_for_more(const RunContext& context) {
  return context.reasons != nullptr || context.evidence != nullptr;
}

/// The answers of a run that has seen all scans. Tracks need the objects of all scans, and may mark
/// some of them, so that the scans are gone through once, and those with marks once more.
class Answers {
 public:
  Answers(const Terrain& terrain, const EvidenceMaps& maps, const Parameters& parameters,
          const ScanSource& scans, RemovalSink& sink, const RunContext& context)
      : terrain_(terrain),
        maps_(maps),
        parameters_(parameters),
        scans_(scans),
        sink_(sink),
        context_(context),
        of_scan_(for_one_of_many(context)),
        unmarked_(scans.size()),
        objects_(scans.size()) {}

  void give() {
    for_scans_at_once("raymoval_plus, objects", "objects", scans_, context_,
                      [&](Scan& scan) { decide_without_tracks(std::move(scan)); });
    marked_ = objects_on_tracks(objects_, parameters_, context_);  // 7
    std::vector<std::size_t> again;  // Scans whose answer changes, or needs more.
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      if (marked_[i].empty() && !asks_for_more(context_)) {
        sink_.accept(i, unmarked_.get(i));
      } else {
        again.push_back(i);
      }
    }
    for_scans_at_once("raymoval_plus, answers", "answers", scans_, again, context_,
                      [&](Scan& scan) { answer_with_tracks(std::move(scan)); });
  }

 private:
  void locate(Scan scan, LocatedScan& located) const {
    located.scan = std::move(scan);
    find_terrain_cells(terrain_, parameters_, of_scan_, located);
    find_heights_and_cells(terrain_, maps_, parameters_, of_scan_, located);
    look_up(maps_, parameters_, of_scan_, located);
  }
  void segment(Scan scan, SegmentedScan& segmented) const {
    locate(std::move(scan), segmented);
    find_clusters(parameters_, of_scan_, segmented);    // 6
    add_evidence_of_points(maps_.standing, segmented);  // 6
  }

  void decide_without_tracks(Scan scan) {
    const std::size_t index = scan.index;
    workspaces_.with_one([&](SegmentedScan& segmented) {
      segment(std::move(scan), segmented);
      objects_[index] = summarise_objects(segmented, maps_.standing, parameters_, of_scan_);
      Verdicts verdicts =
          decide_objects(segmented, {}, maps_.standing, parameters_, of_scan_);  // 6
      decide_low_points(segmented, maps_, parameters_, of_scan_, verdicts);      // 8
      unmarked_.set(index, removed_points(verdicts));
    });
  }

  void answer_with_tracks(Scan scan) {
    const std::size_t index = scan.index;
    workspaces_.with_one([&](SegmentedScan& segmented) {
      segment(std::move(scan), segmented);
      answer(segmented, marked_[index], maps_, parameters_, sink_, of_scan_);  // 6 to 8
    });
  }

  const Terrain& terrain_;
  const EvidenceMaps& maps_;
  const Parameters& parameters_;
  const ScanSource& scans_;
  RemovalSink& sink_;
  const RunContext& context_;
  RunContext of_scan_;  ///< What the steps of one scan get.
  Workspaces<SegmentedScan> workspaces_{[] { return std::make_unique<SegmentedScan>(); }};
  MaskStore unmarked_;                               ///< The answers without tracks.
  std::vector<std::vector<ObjectSummary>> objects_;  ///< Of each scan.
  std::vector<std::vector<int>> marked_;             ///< Clusters of each scan.
};

}  // namespace

void answer_from_map(const Terrain& terrain, const EvidenceMaps& maps, const Parameters& parameters,
                     const ScanSource& scans, RemovalSink& sink, const RunContext& context) {
  Answers(terrain, maps, parameters, scans, sink, context).give();
}

void answer(const SegmentedScan& scan, const std::vector<int>& marked, const EvidenceMaps& maps,
            const Parameters& parameters, RemovalSink& sink, const RunContext& context) {
  const Verdicts by_objects =
      decide_objects(scan, marked, maps.standing, parameters, context);  // 6, 7
  Verdicts decided = by_objects;
  decide_low_points(scan, maps, parameters, context, decided);  // 8
  sink.accept(scan.scan.index, removed_points(decided));
  if (context.reasons != nullptr) {
    context.reasons->accept(scan.scan.index, reasons_for(scan, maps, by_objects, decided));
  }
  if (context.evidence != nullptr) {
    context.evidence->accept(scan.scan.index, evidence_of_points(scan, decided, maps));
  }
}

}  // namespace raymoval::raymoval_plus_method
