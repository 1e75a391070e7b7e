// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/truth_map.h"

#include <memory>

#include "eval/checked_scan.h"
#include "eval/erasor/maps/scan_votes.h"
#include "eval/lattice/cell_means.h"
#include "eval/lattice/label_votes.h"
#include "eval/scan_passes.h"

namespace raymoval::erasor {

class TruthMap::Builder : public ScanVisitor {
 public:
  Builder(const MapRules& rules, TruthMap& map) : rules_(rules), map_(map) {}

  bool begin_pass(std::size_t slots) override {
    slots_.resize(slots);
    switch (++pass_) {
      case 1:
        map_.means_ = MeanTable(map_.cells().size());
        return true;
      case 2:
        map_.voxels_ = static_cast<std::int64_t>(map_.means_.finish());
        votes_ = std::make_unique<LabelVotes>(map_.cells().size());
        return map_.voxels_ > 0;
      default:
        end_votes();
        return false;
    }
  }

  void read(const CheckedScan& scan, std::size_t slot) override {
    Part& part = slots_[slot];
    part.scan = static_cast<std::uint32_t>(scan.scan.index);
    const LabelledCloud placed = place_scan(scan, rules_);
    if (pass_ == 1) {
      part.points = count_points(scan, rules_);
      part.dense = dense_points(placed.points, rules_, map_.map_cells_, part.scan, part.means);
    } else {
      vote(placed, part);
    }
  }

  void take(std::size_t slot) override {
    const Part& part = slots_[slot];
    if (pass_ == 1) {
      map_.points_ += part.points;
      for (const DensePoint& point : part.dense) map_.means_.add(point.cell, point.point);
      return;
    }
    map_.mixed_label_ties_ += part.ties;
    for (const Offer& offer : part.offers) {
      votes_->offer(offer.voter, offer.distance, {semantic_id(offer.word), part.scan}, offer.moves);
    }
  }

 private:
  struct Part {
    std::uint32_t scan = 0;
    PointCounts points;
    CellMeans means;
    std::vector<DensePoint> dense;
    std::vector<Offer> offers;
    std::int64_t ties = 0;
  };

  void vote(const LabelledCloud& placed, Part& part) const {
    const LabelledVoxels dense = voxelise(placed, rules_.options.voxel_size, rules_.classes, 1);
    part.ties = dense.mixed_label_ties;
    part.offers.clear();
    add_offers(
        dense.cloud, rules_, map_.cells(), [](Number number) { return number; },
        [&](Number number) { return map_.mean(number); }, part.offers);
  }

  void end_votes() {
    const std::size_t cells = map_.cells().size();
    map_.labels_.assign(cells, {});
    for (Number i = 0; i < cells; ++i) {
      if (!is_voxel(map_.mean(i))) continue;
      const LabelVotes::Label label = votes_->label(i);
      map_.labels_[i] = {static_cast<std::uint32_t>(kind_of(label.id, rules_.classes)),
                         label.scan & kScanBits};
      map_.unlabelled_voxels_ += label.id <= 1 ? 1 : 0;
      map_.mixed_label_ties_ += votes_->is_mixed_tie(i) ? 1 : 0;
    }
  }

  static constexpr std::uint32_t kScanBits = (std::uint32_t{1} << 29) - 1;

  MapRules rules_;
  TruthMap& map_;
  int pass_ = 0;
  std::vector<Part> slots_;
  std::unique_ptr<LabelVotes> votes_;
};

TruthMap::TruthMap(const MapRules& rules) : map_cells_(erasor::map_cells(rules)) {
  Builder builder(rules, *this);
  run_passes(rules.input, "ground truth map", {&builder});
}

std::size_t TruthMap::bytes() const {
  return map_cells_.bytes() + means_.bytes() + labels_.capacity() * sizeof(Label);
}

}  // namespace raymoval::erasor
