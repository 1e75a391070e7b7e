// SPDX-License-Identifier: MIT
// The eight steps of README.md; the numbers in comments are those of the steps there.
#include "methods/raymoval_plus/raymoval_plus.h"

#include "core/scan/mask_store.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/raymoval_plus/evidence/evidence.h"
#include "methods/raymoval_plus/evidence/vote.h"
#include "methods/raymoval_plus/objects/objects.h"
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

/// One run of the method: what it knows of the world, and the steps in the order of each variant.
class Run {
 public:
  Run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
      const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        sink_(sink),
        context_(context),
        terrain_(parameters),
        map_(parameters.voxel_size),
        image_(scans.sensor(), parameters),
        earlier_scans_(parameters) {}

  /// Four passes, and a fifth over the scans in which a track marked something.
  void offline() {
    if (parameters_.terrain) {
      for_each_scan("raymoval_plus, terrain", scans_, context_, [&](Scan scan) {
        terrain_.add(to_world(std::move(scan), context_).points, context_);  // 1
      });
      terrain_.update(context_);  // 1
    }
    for_each_scan("raymoval_plus, voxels", scans_, context_, [&](Scan scan) {
      add_voxels(to_world(std::move(scan), context_));  // 2
    });
    for_each_scan("raymoval_plus, evidence", scans_, context_, [&](const Scan& scan) {
      image_.fill(scan, context_);                                             // 3
      add_evidence(image_, scan.T_world_sensor, parameters_, context_, map_);  // 3, 4
    });
    answer_from_map();  // 5 to 8
  }

  /// One pass, another one for the answers, and a third as above.
  void online_map() {
    for_each_scan("raymoval_plus, scans", scans_, context_,
                  [&](Scan scan) { add_arriving(std::move(scan)); });  // 1 to 4
    answer_from_map();                                                 // 5 to 8
  }

  /// One pass, in which each scan is answered from it and those before.
  void online() {
    ObjectTracker tracker(parameters_);
    for_each_scan("raymoval_plus, scans", scans_, context_, [&](Scan scan) {
      LocatedScan located = add_arriving(std::move(scan));          // 1 to 4
      vote(blocks_of(located, map_), parameters_, context_, map_);  // 5
      const SegmentedScan segmented = segment(std::move(located));  // 6
      tracker.follow(segmented.scan.index, summarise(segmented));   // 7
      answer(segmented, tracker.marked_now());                      // 6 to 8
    });
  }

 private:
  /// Steps 1 to 4 for a scan that is read only once.
  LocatedScan add_arriving(Scan scan) {
    const std::size_t index = scan.index, first_new = map_.size();
    const Pose pose = scan.T_world_sensor;
    WorldScan world = to_world(std::move(scan), context_);
    if (parameters_.terrain) {
      terrain_.add(world.points, context_);  // 1
      if (index % static_cast<std::size_t>(parameters_.terrain_period) == 0) {
        terrain_.update(context_);  // 1
      }
    }
    LocatedScan located = add_voxels(std::move(world));                          // 2
    image_.fill(located.scan, context_);                                         // 3
    earlier_scans_.add_evidence(first_new, pose.translation(), context_, map_);  // 3, 4
    add_evidence(image_, pose, parameters_, context_, map_);                     // 3, 4
    earlier_scans_.keep(image_, pose);
    return located;
  }

  /// Steps 5 to 8 for all scans, from a terrain and a map that hold what all of them say.
  void answer_from_map() {
    vote(parameters_, context_, map_);  // 5
    MaskStore unmarked(scans_.size());
    std::vector<std::vector<ObjectSummary>> objects(scans_.size());
    for_each_scan("raymoval_plus, objects", scans_, context_, [&](Scan scan) {
      const SegmentedScan segmented = segment(locate_scan(std::move(scan)));  // 6
      objects[segmented.scan.index] = summarise(segmented);
      const Verdicts by_objects = decide_objects(segmented, {}, parameters_, context_);  // 6
      const Verdicts decided =
          decide_low_points(segmented, by_objects, parameters_, context_);  // 8
      unmarked.set(segmented.scan.index, removed_points(decided));
    });
    const auto marked = objects_on_tracks(objects, parameters_, context_);  // 7
    std::vector<std::size_t> again;  // Scans whose answer changes, or needs its reasons.
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      if (marked[i].empty() && context_.reasons == nullptr) {
        sink_.accept(i, unmarked.get(i));
      } else {
        again.push_back(i);
      }
    }
    for_each_scan("raymoval_plus, answers", scans_, again, context_, [&](Scan scan) {
      const std::size_t index = scan.index;
      answer(segment(locate_scan(std::move(scan))), marked[index]);  // 6 to 8
    });
  }

  LocatedScan add_voxels(WorldScan world) {
    return add_to_map(std::move(world), terrain_, parameters_, context_, map_);
  }
  [[nodiscard]] LocatedScan locate_scan(Scan scan) const {
    return locate(to_world(std::move(scan), context_), terrain_, map_, parameters_, context_);
  }
  [[nodiscard]] SegmentedScan segment(LocatedScan located) const {
    return find_objects(std::move(located), map_, parameters_, context_);
  }
  [[nodiscard]] std::vector<ObjectSummary> summarise(const SegmentedScan& scan) const {
    return summarise_objects(scan, map_, parameters_, context_);
  }
  /// Steps 6 to 8, given the clusters that a track marked.
  void answer(const SegmentedScan& scan, const std::vector<int>& marked) const {
    const Verdicts by_objects = decide_objects(scan, marked, parameters_, context_);      // 6, 7
    const Verdicts decided = decide_low_points(scan, by_objects, parameters_, context_);  // 8
    sink_.accept(scan.scan.index, removed_points(decided));
    if (context_.reasons == nullptr) return;
    context_.reasons->accept(scan.scan.index, reasons_for(scan, map_, by_objects, decided));
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  RemovalSink& sink_;
  const RunContext& context_;
  Terrain terrain_;
  EvidenceMap map_;
  RangeImage image_;
  EarlierScans earlier_scans_;
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  if (context.reasons != nullptr) context.reasons->explain(reason_sentences());
  Run steps(parameters, scans, sink, context);
  if (parameters.at_once) {
    steps.online();
  } else if (parameters.one_pass) {
    steps.online_map();
  } else {
    steps.offline();
  }
}

}  // namespace

std::unique_ptr<Remover> make_raymoval_plus(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::raymoval_plus_method
