// SPDX-License-Identifier: MIT
// The eight steps of README.md; the numbers in comments are those of the steps there.
#include "methods/raymoval_plus/raymoval_plus.h"

#include <array>
#include <numeric>
#include <span>

#include "methods/common/prepared_scans.h"
#include "methods/common/remover_from.h"
#include "methods/common/side_by_side.h"
#include "methods/raymoval_plus/answers.h"
#include "methods/raymoval_plus/evidence/evidence.h"
#include "methods/raymoval_plus/evidence/things.h"
#include "methods/raymoval_plus/evidence/vote.h"
#include "methods/raymoval_plus/objects/objects.h"
#include "methods/raymoval_plus/objects/reasons.h"
#include "methods/raymoval_plus/online/recent_objects.h"
#include "methods/raymoval_plus/online/waiting_scans.h"

namespace raymoval::raymoval_plus_method {
namespace {

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
        maps_(parameters, scans.sensor()),
        image_(scans.sensor(), parameters),
        earlier_scans_(parameters) {}

  /// Four passes, and a fifth over the scans in which a track marked something.
  void offline() {
    if (parameters_.terrain) find_terrain();                                 // 1
    find_voxels();                                                           // 2
    find_evidence();                                                         // 3
    decide_and_vote();                                                       // 4, 5
    answer_from_map(terrain_, maps_, parameters_, scans_, sink_, context_);  // 6 to 8
  }

  /// One pass, another one for the answers, and a third as above.
  void online_map() {
    LocatedScan located;
    for_each_scan("raymoval_plus, scans", scans_, context_, [&](Scan scan) {
      arrive(std::move(scan), located);            // 1
      add_arrived(located, WhenToDecide::kLater);  // 2, 3
    });
    decide_and_vote();                                                       // 4, 5
    answer_from_map(terrain_, maps_, parameters_, scans_, sink_, context_);  // 6 to 8
  }

  /// One pass, in which each scan is answered from those up to a fixed time after it.
  void online() {
    WaitingScans waiting(parameters_.delay);
    RecentObjects recent(parameters_);
    const auto answer_first = [&] {
      answer_by_now(waiting.first(), recent);
      waiting.remove_first();
    };
    for_each_scan("raymoval_plus, scans", scans_, context_, [&](Scan arriving) {
      waiting.tick(arriving.time_s);
      while (waiting.is_overdue()) answer_first();
      SegmentedScan& scan = waiting.add();
      arrive(std::move(arriving), scan);  // 1
      side_by_side(
          context_, [&] { add_arrived(scan, WhenToDecide::kNow); },    // 2 to 4
          [&] { find_clusters(parameters_, beside_others_, scan); });  // 6
      if (parameters_.delay > 0.0) {
        look_up_verdicts(maps_, context_, scan);
        add_evidence_of_points(maps_.standing, scan);
        recent.take(scan, maps_.standing, context_);
      }
      while (waiting.is_due()) answer_first();
    });
    while (!waiting.empty()) {
      context_.check_cancelled();
      const ScanScope timed(context_.times, waiting.first().scan.index);
      answer_first();
    }
  }

 private:
  void find_terrain() {
    for_prepared_scans<LocatedScan>(
        "raymoval_plus, terrain", "terrain", scans_, context_,
        [&](Scan scan, LocatedScan& located, const RunContext& context) {
          located.scan = std::move(scan);
          find_terrain_cells(terrain_, parameters_, context, located);
        },
        [&](LocatedScan& located, const RunContext& context) {
          terrain_.add(located.in_terrain, context);
        });
    terrain_.update(context_);
  }

  void find_voxels() {
    for_prepared_scans<LocatedScan>(
        "raymoval_plus, voxels", "voxels", scans_, context_,
        [&](Scan scan, LocatedScan& located, const RunContext& context) {
          located.scan = std::move(scan);
          find_terrain_cells(terrain_, parameters_, context, located);
          find_heights_and_cells(terrain_, maps_, parameters_, context, located);
          BeamImage image(scans_.sensor(), parameters_);
          image.fill(located.scan);
          image.find_extensions(located.extensions);
        },
        [&](LocatedScan& located, const RunContext& context) {
          add_to_maps(parameters_, context, located, maps_);
        });
  }

  void find_evidence() {
    std::vector<BeamImage> images(scans_in_a_batch(scans_, context_), image_);
    std::vector<PosedImage> posed(images.size());
    for_scan_batches("raymoval_plus, evidence", scans_, context_, [&](std::span<Scan> batch) {
      fill_images(batch, images, posed);
      for (EvidenceMap* const map : maps_.both()) {
        add_evidence(std::span(posed).first(batch.size()), parameters_, WhenToDecide::kLater,
                     context_, *map);
      }
    });
  }

  void decide_and_vote() {
    for (EvidenceMap* const map : maps_.both()) {
      decide_all(parameters_, context_, *map);
      vote(parameters_, context_, *map);
    }
    std::vector<std::uint32_t> all(maps_.standing.blocks().block_count());
    std::iota(all.begin(), all.end(), 0U);
    find_passes_outside(all, context_, maps_.standing);
  }

  void fill_images(std::span<const Scan> batch, std::vector<BeamImage>& images,
                   std::vector<PosedImage>& posed) const {
    const StageScope timed(context_.times, "range image");
    parallel_for(context_.threads, batch.size(), 1, [&](std::size_t i) {
      images[i].fill(batch[i]);
      posed[i] = {&images[i], batch[i].T_world_sensor.translation(), batch[i].index};
    });
  }

  /// Takes a scan that is read only once, and makes its range image. Step 1.
  void arrive(Scan scan, LocatedScan& located) {
    located.scan = std::move(scan);
    const auto add_to_terrain = [&] {
      find_terrain_cells(terrain_, parameters_, beside_others_, located);
      if (parameters_.terrain) terrain_.add(located.in_terrain, beside_others_);
    };
    const auto fill_image = [&] {
      const StageScope timed(beside_others_.times, "range image");
      image_.fill(located.scan);
    };
    {
      const StageScope timed(context_.threads > 1 ? context_.times : nullptr,
                             "terrain and range image");
      side_by_side(context_, add_to_terrain, fill_image);
    }
    image_.find_extensions(located.extensions);
    const bool is_due =
        located.scan.index % static_cast<std::size_t>(parameters_.terrain_period) == 0;
    if (parameters_.terrain && is_due) terrain_.update(context_);
    find_heights_and_cells(terrain_, maps_, parameters_, context_, located);
  }

  /// Steps 2 to 4 for a scan that is read only once.
  void add_arrived(LocatedScan& located, WhenToDecide when) {
    const auto known = maps_.sizes();
    const PosedImage posed{&image_, located.scan.T_world_sensor.translation(), located.scan.index};
    add_to_maps(parameters_, context_, located, maps_);  // 2
    ask_earlier_scans(known, posed.position, when);      // 3, 4
    for (EvidenceMap* const map : maps_.both()) {
      add_evidence(std::span(&posed, 1), parameters_, when, context_, *map);  // 3, 4
    }
    earlier_scans_.keep(std::move(image_), posed.scan);
  }

  /// Steps 3 and 4 for the voxels that were added since the maps had so many.
  void ask_earlier_scans(const std::array<std::size_t, 2>& known, const Eigen::Vector3d& center,
                         WhenToDecide when) {
    for (std::size_t i = 0; i < known.size(); ++i) {
      earlier_scans_.add_evidence(known[i], center, when, context_, *maps_.both()[i]);
    }
  }

  /// Steps 1 to 4 and 6 for a scan that has waited: the ground below a person who fills a column is
  /// seen only when he has gone on.
  void find_heights_again(SegmentedScan& scan) {
    const auto known = maps_.sizes();
    find_heights(terrain_, parameters_, context_, scan);  // 1
    correct_voxels(parameters_, context_, scan, maps_);   // 2
    ask_earlier_scans(known, scan.scan.T_world_sensor.translation(),
                      WhenToDecide::kNow);       // 3, 4
    find_clusters(parameters_, context_, scan);  // 6
  }

  /// Steps 5 to 8 for a scan, by the map and the objects as they are now.
  void answer_by_now(SegmentedScan& scan, RecentObjects& recent) {
    if (parameters_.delay > 0.0) find_heights_again(scan);
    std::vector<std::uint32_t> blocks = blocks_of(scan.voxel, maps_.standing);
    recent.add_blocks(maps_.standing, blocks);
    vote(blocks, parameters_, context_, maps_.standing);                                    // 5
    vote(blocks_of(scan.ground_voxel, maps_.ground), parameters_, context_, maps_.ground);  // 5
    look_up_verdicts(maps_, context_, scan);
    find_passes_outside(blocks, context_, maps_.standing);  // 6
    add_evidence_of_points(maps_.standing, scan);           // 6
    recent.take(scan, maps_.standing, context_);
    recent.judge(maps_.standing, context_);
    answer(scan, recent.marked(scan.scan.index, context_), maps_, parameters_, sink_,
           context_);  // 6 to 8
    recent.forget_before(scan.scan.index + 1);
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  RemovalSink& sink_;
  const RunContext& context_;
  RunContext beside_others_ = for_one_of_many(context_);
  Terrain terrain_;
  EvidenceMaps maps_;
  BeamImage image_;
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
