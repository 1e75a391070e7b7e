// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

#include <algorithm>
#include <numeric>

#include "methods/common/scan_passes.h"
#include "methods/raymoval_plus/arriving_scans.h"
#include "methods/raymoval_plus/evidence.h"
#include "methods/raymoval_plus/judge.h"
#include "methods/raymoval_plus/verdicts.h"

namespace raymoval {
namespace {

/// A mask as the places where it changes: what is removed comes in runs.
class PackedMask {
 public:
  PackedMask() = default;
  explicit PackedMask(const Mask& mask) : size_(mask.size()) {
    for (std::size_t k = 0; k < mask.size(); ++k) {
      if ((mask[k] != 0) != (changes_.size() % 2 != 0)) {
        changes_.push_back(static_cast<std::uint32_t>(k));
      }
    }
  }
  [[nodiscard]] Mask unpacked() const {
    Mask mask(size_, 0);
    for (std::size_t i = 0; i < changes_.size(); i += 2) {
      const std::size_t end = i + 1 < changes_.size() ? changes_[i + 1] : size_;
      std::fill(mask.begin() + changes_[i], mask.begin() + static_cast<std::ptrdiff_t>(end), 1);
    }
    return mask;
  }

 private:
  std::size_t size_ = 0;
  std::vector<std::uint32_t> changes_;
};

/// Blocks of voxels, all of them.
std::vector<std::uint32_t> all_blocks(const EvidenceMap& map) {
  std::vector<std::uint32_t> blocks(map.blocks().block_count());
  std::iota(blocks.begin(), blocks.end(), 0U);
  return blocks;
}

/// Blocks that hold points of a scan, ascending.
std::vector<std::uint32_t> blocks_of(const WorldScan& world, const EvidenceMap& map) {
  std::vector<std::uint32_t> blocks;
  for (const std::uint32_t voxel : world.voxel) {
    if (voxel == EvidenceMap::kNone) continue;
    const std::uint32_t block = map.block_of(voxel);
    if (blocks.empty() || blocks.back() != block) blocks.push_back(block);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

/// Gives a scan's answer, and the reasons for it to whom they are of use.
void hand_over(const WorldScan& world, RemovalSink& sink, const RunContext& context) {
  sink.accept(world.scan.index, removed_points(world));
  if (context.reasons != nullptr) context.reasons->accept(world.scan.index, world.reason);
}

/// Answers scans from a terrain and a map that hold what all scans say.
class Answers {
 public:
  Answers(const Terrain& terrain, EvidenceMap& map, const RaymovalPlusParameters& parameters)
      : terrain_(terrain), map_(map), parameters_(parameters) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) {
    {
      const StageScope timed(context.times, "vote");
      vote(all_blocks(map_), parameters_, context.threads, map_);
    }
    judge_scans(scans, context);
    {
      const StageScope timed(context.times, "tracks");
      marked_ = objects_on_tracks(found_, parameters_);
      found_.clear();
    }
    answer(scans, sink, context);
  }

 private:
  [[nodiscard]] WorldScan judged(Scan scan, const Marking& marking,
                                 const RunContext& context) const {
    WorldScan world = in_world(std::move(scan), context.threads);
    measure_heights(terrain_, parameters_, context.threads, world);
    judge(map_, parameters_, marking, context, world);
    return world;
  }

  void judge_scans(const ScanSource& scans, const RunContext& context) {
    answers_.resize(scans.size());
    found_.resize(scans.size());
    for_each_scan("raymoval_plus, objects", scans, context, [&](Scan scan) {
      const std::size_t index = scan.index;
      const auto note = [&](std::vector<ObjectSummary> objects) {
        found_[index] = std::move(objects);
        return std::vector<int>();
      };
      answers_[index] = PackedMask(removed_points(judged(std::move(scan), note, context)));
    });
  }

  /// Scans with objects marked by a track are judged again, the others stand.
  void answer(const ScanSource& scans, RemovalSink& sink, const RunContext& context) {
    context.begin_pass("raymoval_plus, answers", scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      context.check_cancelled();
      if (marked_[i].empty() && context.reasons == nullptr) {
        sink.accept(i, answers_[i].unpacked());
      } else {
        Scan scan = scans.load(i);
        const ScanScope timed(context.times, i);
        const auto mark = [&](const std::vector<ObjectSummary>&) { return marked_[i]; };
        hand_over(judged(std::move(scan), mark, context), sink, context);
      }
      context.advance();
    }
  }

  const Terrain& terrain_;
  EvidenceMap& map_;
  const RaymovalPlusParameters& parameters_;
  std::vector<PackedMask> answers_;
  std::vector<std::vector<ObjectSummary>> found_;  ///< By scan.
  std::vector<std::vector<int>> marked_;           ///< By scan: clusters that moved at some time.
};

/// Three passes for terrain, voxels and evidence, then the answers.
class OfflineRemover : public Remover {
 public:
  explicit OfflineRemover(const RaymovalPlusParameters& parameters)
      : parameters_(parameters), terrain_(parameters), map_(parameters.voxel_size) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    if (context.reasons != nullptr) context.reasons->explain(reason_sentences());
    if (parameters_.terrain) find_terrain(scans, context);
    collect_voxels(scans, context);
    gather_evidence(scans, context);
    Answers(terrain_, map_, parameters_).run(scans, sink, context);
  }

 private:
  void find_terrain(const ScanSource& scans, const RunContext& context) {
    for_each_scan("raymoval_plus, terrain", scans, context, [&](Scan scan) {
      const StageScope timed(context.times, "terrain");
      terrain_.add(in_world(std::move(scan), context.threads).points);
    });
    const StageScope timed(context.times, "terrain");
    terrain_.update(context.threads);
  }

  void collect_voxels(const ScanSource& scans, const RunContext& context) {
    for_each_scan("raymoval_plus, voxels", scans, context, [&](Scan scan) {
      const StageScope timed(context.times, "voxels");
      WorldScan world = in_world(std::move(scan), context.threads);
      measure_heights(terrain_, parameters_, context.threads, world);
      add_to_map(parameters_, world, map_);
    });
  }

  void gather_evidence(const ScanSource& scans, const RunContext& context) {
    RangeImage image(scans.sensor(), parameters_);
    for_each_scan("raymoval_plus, evidence", scans, context, [&](const Scan& scan) {
      {
        const StageScope timed(context.times, "range image");
        image.fill(scan);
      }
      const StageScope timed(context.times, "evidence");
      add_evidence(image, scan.T_world_sensor, parameters_, context.threads, map_);
    });
  }

  RaymovalPlusParameters parameters_;
  Terrain terrain_;
  EvidenceMap map_;
};

/// One pass for all of these, as scans arrive; each scan is answered at once, or all in the end.
class ArrivingRemover : public Remover {
 public:
  explicit ArrivingRemover(const RaymovalPlusParameters& parameters) : parameters_(parameters) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    if (context.reasons != nullptr) context.reasons->explain(reason_sentences());
    ArrivingScans arrived(scans.sensor(), parameters_);
    Follower follower(parameters_);
    for_each_scan("raymoval_plus, scans", scans, context, [&](Scan scan) {
      WorldScan world = arrived.add(std::move(scan), context.threads, context.times);
      if (!parameters_.at_once) return;
      {
        const StageScope timed(context.times, "vote");
        vote(blocks_of(world, arrived.map()), parameters_, context.threads, arrived.map());
      }
      const auto mark = [&](const std::vector<ObjectSummary>& objects) {
        follower.step(world.scan.index, objects);
        return follower.marked_now();
      };
      judge(arrived.map(), parameters_, mark, context, world);
      hand_over(world, sink, context);
    });
    if (parameters_.at_once) return;
    Answers(arrived.terrain(), arrived.map(), parameters_).run(scans, sink, context);
  }

 private:
  RaymovalPlusParameters parameters_;
};

}  // namespace

std::unique_ptr<Remover> make_raymoval_plus(const RaymovalPlusParameters& parameters) {
  if (parameters.at_once || parameters.one_pass) {
    return std::make_unique<ArrivingRemover>(parameters);
  }
  return std::make_unique<OfflineRemover>(parameters);
}

}  // namespace raymoval
