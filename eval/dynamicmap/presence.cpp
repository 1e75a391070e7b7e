// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/presence.h"

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "eval/dynamicmap/fine_cells.h"
#include "eval/dynamicmap/marked_cells.h"
#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/coarse_cells.h"
#include "eval/lattice/ranked_bits.h"
#include "eval/points/nearest_points.h"
#include "eval/scan_passes.h"

namespace raymoval::dynamicmap {
namespace {

/// Flagged points that have a kept point near but not in their fine cell, and the kept points
/// around them, for a range of blocks at a time. The range begins with all blocks that are given.
/// If there are too many points, its end moves down and the points beyond it are dropped. A later
/// pass handles them.
class UndecidedPoints {
 public:
  using Number = CellLattice::Number;

  struct Map {
    double distance;
    const FineGrid& grid;
    const CellLattice& blocks;
    const FineBits& flagged;  ///< Cells whose flagged points are undecided.
  };
  struct Flagged {
    Eigen::Vector3d point;
    Number block;
    std::uint32_t scan;
    bool moving;
  };
  /// The points of one scan.
  struct Found {
    std::vector<Flagged> flagged;
    std::vector<Eigen::Vector3d> kept;
  };

  /// @param map outlives this object
  /// @param room bytes for points
  UndecidedPoints(const Map& map, std::size_t room);

  /// Begins with the blocks [first, last). The marks of `flagged` are complete now.
  void begin(Number first, Number last);
  /// Begins with those of them that are behind the last range. @return false if there is none
  bool begin_next();

  /// Whether the flagged points of a block are collected in this pass. It may be true for a block
  /// that is dropped meanwhile; `add` checks again.
  [[nodiscard]] bool has_turn(Number block) const { return block >= first_ && block < end_; }
  /// Whether undecided flagged points may be near a block.
  [[nodiscard]] bool is_near_flagged(Number block) const { return is_near_flagged_.test(block); }
  /// Whether a collected flagged point may be near a kept point in this cell.
  [[nodiscard]] bool is_wanted(const FineCell& cell, CellLattice::Cursor& cursor) const {
    return map_.flagged.any_near(cell, map_.blocks, cursor, first_, end_);
  }
  void add(const Found& found);

  /// Calls `present` for each collected flagged point that has a kept point within the distance,
  /// and forgets all points.
  void search(int threads, const std::function<void(const Flagged&)>& present);

  /// Bytes of memory of the points and of their search.
  [[nodiscard]] std::size_t bytes() const;

 private:
  bool narrow();

  Map map_;
  std::size_t room_;
  Number first_ = 0;
  std::atomic<Number> end_ = 0;
  Number last_ = 0;             ///< Where the ranges end.
  RankedBits is_near_flagged_;  ///< Of each block: it, or one beside it, is flagged.
  std::vector<Flagged> flagged_;
  std::vector<Eigen::Vector3d> kept_;
};

/// Memory of a kept point in the search tree.
constexpr std::size_t kTreeBytes = 16;
constexpr std::size_t kGrain = 4096;

UndecidedPoints::UndecidedPoints(const Map& map, std::size_t room) : map_(map), room_(room) {}

void UndecidedPoints::begin(Number first, Number last) {
  is_near_flagged_ = RankedBits(map_.blocks.size());
  CellLattice::Cursor cursor;
  map_.blocks.for_each([&](Number number, VoxelKey block) {
    if (map_.flagged.any(number)) set_blocks_around(block, map_.blocks, cursor, is_near_flagged_);
  });
  first_ = first;
  end_ = last_ = last;
}

bool UndecidedPoints::begin_next() {
  first_ = end_;
  end_ = last_;
  return first_ < end_;
}

void UndecidedPoints::add(const Found& found) {
  for (const Flagged& point : found.flagged) {
    if (has_turn(point.block)) flagged_.push_back(point);
  }
  kept_.insert(kept_.end(), found.kept.begin(), found.kept.end());
  while (bytes() > room_ && narrow()) {
  }
}

std::size_t UndecidedPoints::bytes() const {
  return flagged_.size() * sizeof(Flagged) + kept_.size() * (sizeof(Eigen::Vector3d) + kTreeBytes);
}

/// Halves the flagged points by ending the range sooner. @return false if it is one block already
bool UndecidedPoints::narrow() {
  if (flagged_.empty() || end_ - first_ <= 1) return false;
  std::vector<Number> blocks;
  blocks.reserve(flagged_.size());
  for (const Flagged& point : flagged_) blocks.push_back(point.block);
  const auto middle = blocks.begin() + static_cast<std::ptrdiff_t>(blocks.size() / 2);
  std::nth_element(blocks.begin(), middle, blocks.end());
  const Number end = std::max(*middle, first_ + 1);
  if (end >= end_) return false;
  end_ = end;
  std::erase_if(flagged_, [&](const Flagged& point) { return point.block >= end; });
  CellLattice::Cursor cursor;
  std::erase_if(kept_, [&](const Eigen::Vector3d& point) {
    return !map_.flagged.any_near(map_.grid.cell_of(point), map_.blocks, cursor, first_, end);
  });
  flagged_.shrink_to_fit();
  kept_.shrink_to_fit();
  return true;
}

void UndecidedPoints::search(int threads, const std::function<void(const Flagged&)>& present) {
  const NearbyPoints<Eigen::Vector3d> near(kept_, map_.distance);
  std::vector<std::uint8_t> is_present(flagged_.size(), 0);
  parallel_for(threads, flagged_.size(), kGrain,
               [&](std::size_t i) { is_present[i] = near.has_near(flagged_[i].point) ? 1 : 0; });
  for (std::size_t i = 0; i < flagged_.size(); ++i) {
    if (is_present[i] != 0) present(flagged_[i]);
  }
  flagged_ = {};
  kept_ = {};
}

/// From this number on, waiting is worth an extra pass, because marks need much memory.
constexpr std::size_t kManyBlocks = 4'000'000;

Eigen::Vector3d placed(const Scan& scan, std::size_t point) {
  return scan.T_world_sensor * scan.points[point].cast<double>();
}

/// Counts of a scan from its mask; calls `visit(scan, point, kind, removed)` for each point.
template <class Visit>
ScanPresence count_by_index(const TruthPoints& truth, const CheckedScan& loaded, Visit&& visit) {
  ScanPresence counts;
  counts.points =
      truth.visit_scan(loaded, [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
        if (kind == Kind::kStatic && !removed) ++counts.kept_static;
        if (kind == Kind::kDynamic && removed) ++counts.flagged_dynamic;
        visit(scan, p, kind, removed);
      });
  counts.present_static = counts.kept_static;
  counts.removed_dynamic = counts.flagged_dynamic;
  return counts;
}

/// Counts a flagged point that is present.
void add_present(ScanPresence& counts, bool moving) {
  if (moving) {
    --counts.removed_dynamic;
  } else {
    ++counts.present_static;
  }
}

}  // namespace

ScanPresence& ScanPresence::operator+=(const ScanPresence& other) {
  points += other.points;
  kept_static += other.kept_static;
  flagged_dynamic += other.flagged_dynamic;
  present_static += other.present_static;
  removed_dynamic += other.removed_dynamic;
  return *this;
}

std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks) {
  std::vector<ScanPresence> scans(truth.input().scans->size());
  parallel_for(truth.input().threads, scans.size(), 1, [&](std::size_t i) {
    scans[i] = count_by_index(truth, load_checked(truth.input(), &masks, i),
                              [](const Scan&, std::size_t, Kind, bool) {});
  });
  return scans;
}

TruthBlocks truth_blocks(const TruthPoints& truth, const FineGrid& grid) {
  struct Part {
    CellSet blocks;
    PointCounts points;
  };
  std::vector<Part> slots(usual_slots(truth.input()));
  Part all;
  TruthBlocks result;
  in_scan_order(
      truth.input(), "ground truth points", slots.size(),
      [&](std::size_t index, std::size_t slot) {
        Part& part = slots[slot];
        part.blocks.clear();
        CellInserter blocks(part.blocks);
        part.points = truth.visit_scan(load_checked(truth.input(), nullptr, index),
                                       [&](std::size_t p, const Scan& scan, Kind, bool) {
                                         blocks.insert(grid.block_of(placed(scan, p)));
                                       });
      },
      [&](std::size_t slot) {
        all.blocks.insert(slots[slot].blocks);
        all.points += slots[slot].points;
        result.points.push_back(slots[slot].points);
      });
  check_not_empty(all.points);
  result.blocks = CellLattice(std::move(all.blocks));
  return result;
}

namespace {

/// The passes that `PresenceCount` describes.
class MarkedPresence : public PresenceCount {
 public:
  MarkedPresence(const Input& input, const Room& room)
      : input_(input),
        scans_(input.truth.input().scans->size()),
        marks_(blocks(), room_for(room.marks, kMarksPerBlock)),
        undecided_({input.options.distance, input.grid, blocks(), marks_.flagged()},
                   room_for(room.points, kPointsPerBlock)) {}

  bool begin_pass(std::size_t slots) override {
    slots_.resize(slots);
    switch (step_) {
      case kStart:
        step_ = kCount;
        return true;
      case kCount:
        return needs_marks() && begin_marks();
      case kMark:
        if (input_.grid.same_cell_is_near()) marks_.leave_undecided();
        undecided_.begin(marks_.first(), marks_.end());
        places_ = places_where(
            [&](CellLattice::Number block) { return undecided_.is_near_flagged(block); });
        step_ = kCollect;
        return true;
      default:
        search();
        step_ = kCollectMore;
        return undecided_.begin_next() || begin_marks();
    }
  }

  /// After the first pass, if the map is large.
  [[nodiscard]] bool runs_last() const override {
    return step_ != kStart && needs_marks() && blocks().size() >= kManyBlocks;
  }

  [[nodiscard]] std::size_t bytes() const override {
    return scans_.capacity() * sizeof(ScanPresence) + marks_.bytes() + undecided_.bytes();
  }

  void read(const CheckedScan& scan, std::size_t slot) override {
    Part& part = slots_[slot];
    part.scan = static_cast<std::uint32_t>(scan.scan.index);
    if (step_ == kCount) {
      count(scan, part);
    } else if (step_ == kMark) {
      mark(scan, part);
    } else {
      collect(scan, part);
    }
  }

  void take(std::size_t slot) override {
    Part& part = slots_[slot];
    if (step_ == kCount) {
      scans_[part.scan] = part.counts;
      any_flagged_ = any_flagged_ || part.any_flagged;
      any_kept_ = any_kept_ || part.any_kept;
    } else if (step_ != kMark) {
      if (step_ == kCollect) scans_[part.scan] += part.counts;
      undecided_.add(part.found);
    }
  }

  [[nodiscard]] std::vector<ScanPresence> finish() override { return std::move(scans_); }

 private:
  /// The steps of the passes. The last three are repeated for each range of marks.
  enum Step { kStart, kCount, kMark, kCollect, kCollectMore };
  struct Part {
    std::uint32_t scan = 0;
    ScanPresence counts;
    bool any_flagged = false, any_kept = false;
    UndecidedPoints::Found found;
  };

  [[nodiscard]] const CellLattice& blocks() const { return input_.blocks.blocks; }

  [[nodiscard]] std::size_t room_for(std::size_t wanted, std::size_t per_block) const {
    constexpr std::size_t kLeastRoom = std::size_t{128} << 20;
    return wanted != 0 ? wanted : std::max(kLeastRoom, per_block * blocks().size());
  }

  /// Otherwise all points are present, or all are gone.
  [[nodiscard]] bool needs_marks() const { return any_flagged_ && any_kept_; }

  bool begin_marks() {
    if (!marks_.begin_next()) return false;
    places_ =
        places_where([&](CellLattice::Number block) { return marks_.is_near_flagged(block); });
    step_ = kMark;
    return true;
  }

  /// The block of a point. All points of the truth have one.
  [[nodiscard]] CellLattice::Number block_at(const Eigen::Vector3d& point, const Part& part,
                                             CellLattice::Cursor& cursor) const {
    const CellLattice::Number block = blocks().find(input_.grid.block_of(point), cursor);
    if (block == CellLattice::kNone) throw_changed(input_.truth.input(), part.scan);
    return block;
  }

  /// The places of the wanted blocks. Most points of a scan are elsewhere.
  template <class IsWanted>
  [[nodiscard]] CoarseCells places_where(IsWanted&& is_wanted) const {
    return {input_.grid.blocks_a_metre(), [&](const auto& visit) {
              blocks().for_each([&](CellLattice::Number block, VoxelKey key) {
                if (is_wanted(block)) visit(voxel_index(key));
              });
            }};
  }

  /// Counts the points of the mask, and finds the blocks of flagged points.
  void count(const CheckedScan& loaded, Part& part) {
    ScanPresence& counts = part.counts;
    counts = {};
    counts.points = input_.blocks.points[part.scan];
    counts.kept_static = counts.points.static_points;
    std::int64_t kept = counts.points.static_points + counts.points.dynamic_points;
    if (input_.options.ignored_in_estimate) kept += counts.points.ignored;
    part.any_flagged = false;
    CellLattice::Cursor cursor;
    input_.truth.visit_flagged(loaded, [&](std::size_t p, const Scan& scan, Kind kind) {
      if (in_estimate(kind, false)) --kept;
      if (!is_truth(kind)) return;
      part.any_flagged = true;
      if (kind == Kind::kStatic) --counts.kept_static;
      if (kind == Kind::kDynamic) ++counts.flagged_dynamic;
      marks_.note_flagged(block_at(placed(scan, p), part, cursor));
    });
    counts.present_static = counts.kept_static;
    counts.removed_dynamic = counts.flagged_dynamic;
    part.any_kept = kept > 0;
  }

  /// Marks the cells of flagged points, and of kept points that may be near flagged points.
  void mark(const CheckedScan& loaded, const Part& part) {
    const auto may_matter = [&](CellLattice::Number block, bool removed) {
      return removed ? marks_.has_turn(block) : marks_.is_near_flagged(block);
    };
    const auto set = [&](const Eigen::Vector3d& point, CellLattice::Number block, Kind,
                         bool removed) { marks_.mark(block, input_.grid.cell_of(point), removed); };
    visit_where(loaded, part, may_matter, set);
  }

  /// Counts the flagged points that the marks decide, and collects the others and kept points that
  /// may be near them.
  void collect(const CheckedScan& loaded, Part& part) {
    part.counts = {};
    part.found = {};
    CellLattice::Cursor around;
    const auto may_matter = [&](CellLattice::Number block, bool removed) {
      return removed ? marks_.has_turn(block) : undecided_.is_near_flagged(block);
    };
    const auto add = [&](const Eigen::Vector3d& point, CellLattice::Number block, Kind kind,
                         bool removed) {
      const FineCell cell = input_.grid.cell_of(point);
      if (!removed) {
        if (undecided_.is_wanted(cell, around)) part.found.kept.push_back(point);
        return;
      }
      const bool moving = kind == Kind::kDynamic;
      if (input_.grid.same_cell_is_near() && marks_.kept().is_set(block, cell)) {
        add_present(part.counts, moving);
      } else if (undecided_.has_turn(block) &&
                 marks_.kept().any_near(cell, blocks(), around, 0, CellLattice::kNone)) {
        part.found.flagged.push_back({point, block, part.scan, moving});
      }
    };
    visit_where(loaded, part, may_matter, add);
  }

  /// Calls `visit(point, block, kind, removed)` for the points of the estimate in `places_` and for
  /// flagged points if `may_matter(block, removed)`. The block of a point is found before its kind,
  /// because most points are in blocks without flagged points.
  template <class MayMatter, class Visit>
  void visit_where(const CheckedScan& loaded, const Part& part, MayMatter&& may_matter,
                   Visit&& visit) const {
    CellLattice::Cursor cursor;
    for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
      const Eigen::Vector3d point = placed(loaded.scan, i);
      const bool removed = loaded.removed(i);
      if (!removed && !places_.may_hold(point)) continue;
      const auto kind_of = [&] {
        return input_.truth.kind_of(loaded.scan.points[i], loaded.labels[i]);
      };
      if (!input_.grid.holds(point) && kind_of() == Kind::kOutOfRange) continue;
      const CellLattice::Number block = blocks().find(input_.grid.block_of(point), cursor);
      if (block != CellLattice::kNone && !may_matter(block, removed)) continue;
      const Kind kind = kind_of();
      const bool counts = removed ? is_truth(kind) : in_estimate(kind, false);
      if (kind == Kind::kOutOfRange || !counts) continue;
      if (block == CellLattice::kNone) throw_changed(input_.truth.input(), part.scan);
      visit(point, block, kind, removed);
    }
  }

  /// Whether a point is in the scored map, for any label.
  [[nodiscard]] bool in_estimate(Kind kind, bool removed) const {
    return !removed && (is_truth(kind) || input_.options.ignored_in_estimate);
  }

  void search() {
    undecided_.search(input_.truth.input().threads, [&](const UndecidedPoints::Flagged& point) {
      add_present(scans_[point.scan], point.moving);
    });
  }

  Input input_;
  Step step_ = kStart;
  std::vector<Part> slots_;
  std::vector<ScanPresence> scans_;
  bool any_flagged_ = false, any_kept_ = false;
  CoarseCells places_;  ///< Places of kept points that may matter in this pass.
  MarkedCells marks_;   ///< While points are collected: undecided flagged points.
  UndecidedPoints undecided_;
};

}  // namespace

std::unique_ptr<PresenceCount> PresenceCount::start(const Input& input, const Room& room) {
  return std::make_unique<MarkedPresence>(input, room);
}

}  // namespace raymoval::dynamicmap
