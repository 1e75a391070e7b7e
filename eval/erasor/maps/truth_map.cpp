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
        sums_.resize(map_.cells().size());
        return true;
      case 2:
        end_sums();
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
      for (const DensePoint& point : part.dense) sums_[point.to].add(point.point);
      return;
    }
    map_.mixed_label_ties_ += part.ties;
    for (const Offer& offer : part.offers) {
      votes_->offer(offer.voter, offer.distance, {offer.word, part.scan}, offer.moves);
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
        [&](Number number) -> const Eigen::Vector3d& { return map_.means_[number]; }, part.offers);
  }

  void end_sums() {
    map_.means_.reserve(sums_.size());
    for (const OffsetMean& sum : sums_) {
      map_.means_.push_back(sum.mean());
      map_.voxels_ += sum.points > 0 ? 1 : 0;
    }
    sums_ = {};
    votes_ = std::make_unique<LabelVotes>(map_.means_.size());
  }

  void end_votes() {
    map_.kinds_.assign(map_.means_.size(), VoxelKind::kNone);
    map_.scans_.assign(map_.means_.size(), 0);
    for (std::size_t i = 0; i < map_.means_.size(); ++i) {
      if (!is_voxel(map_.means_[i])) continue;
      const LabelVotes::Label& label = votes_->label(i);
      map_.kinds_[i] = kind_of(label.word, rules_.classes);
      map_.scans_[i] = label.scan;
      map_.unlabelled_voxels_ += semantic_id(label.word) <= 1 ? 1 : 0;
      map_.mixed_label_ties_ += votes_->is_mixed_tie(i) ? 1 : 0;
    }
  }

  MapRules rules_;
  TruthMap& map_;
  int pass_ = 0;
  std::vector<Part> slots_;
  std::vector<OffsetMean> sums_;  ///< By number, in the first pass.
  std::unique_ptr<LabelVotes> votes_;
};

TruthMap::TruthMap(const MapRules& rules) : map_cells_(erasor::map_cells(rules)) {
  Builder builder(rules, *this);
  run_passes(rules.input, "ground truth map", {&builder});
}

}  // namespace raymoval::erasor
