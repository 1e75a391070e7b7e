// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "eval/erasor/maps/map_cells.h"
#include "eval/erasor/maps/map_voxels.h"
#include "eval/erasor/maps/scan_votes.h"
#include "eval/erasor/maps/truth_map.h"
#include "eval/lattice/cell_means.h"
#include "eval/lattice/coarse_cells.h"
#include "eval/lattice/label_votes.h"
#include "eval/lattice/mean_table.h"
#include "eval/lattice/ranked_bits.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// The map of the kept points, bit for bit equal to `voxelise` of their dense map. It stores only
/// the differences from the truth. The first pass finds the touched cells, in which points were
/// removed. The second one adds up their voxels' means; all other voxels are those of the truth.
/// The third one lets points vote for labels where both classes are near; elsewhere all labels are
/// static. It takes 52 bytes per touched cell, 24 afterwards, and 16 per voting cell.
class EstimateMap : public ScanVisitor, public MapVoxels {
 public:
  /// @param truth of the same scans; must outlive this object
  EstimateMap(const MapRules& rules, const TruthMap& truth);

  bool begin_pass(std::size_t slots) override;
  void read(const CheckedScan& scan, std::size_t slot) override;
  void take(std::size_t slot) override;

  // After the last pass:
  [[nodiscard]] const CellLattice& cells() const override { return truth_.cells(); }
  [[nodiscard]] Eigen::Vector3d mean(Number number) const override {
    if (!touched_.test(number)) return truth_.mean(number);
    return is_empty() ? no_mean() : means_.mean(touched_.rank(number));
  }
  [[nodiscard]] VoxelKind kind(Number number) const override;
  [[nodiscard]] const PointCounts& points() const { return points_; }
  [[nodiscard]] std::int64_t mixed_label_ties() const { return mixed_label_ties_; }

  /// Present bytes of memory, without the truth.
  [[nodiscard]] std::size_t bytes() const {
    return touched_.bytes() + means_.bytes() + (votes_ ? votes_->bytes() : 0);
  }

 private:
  enum Pass { kTouch = 1, kAddUp, kVote };
  struct Part {
    std::uint32_t scan = 0;
    std::int64_t removed = 0;
    CellMeans means;
    std::vector<DensePoint> dense;
    std::vector<Offer> offers;
    std::int64_t ties = 0;
  };

  /// Whether all points were removed. Then no mean is kept.
  [[nodiscard]] bool is_empty() const { return points_.removed == points_.evaluated; }
  static Eigen::Vector3d no_mean() {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }

  void touch(const CheckedScan& scan, Part& part);
  void add_up(const CheckedScan& scan, Part& part) const;
  void vote(const CheckedScan& scan, Part& part) const;
  [[nodiscard]] CoarseCells places_of(const RankedBits& wanted) const;
  [[nodiscard]] LabelledCloud points_in(const CheckedScan& scan, const RankedBits& wanted) const;
  bool begin_votes();

  MapRules rules_;
  const TruthMap& truth_;
  int pass_ = 0;
  std::vector<Part> slots_;
  PointCounts points_;
  RankedBits touched_;
  CoarseCells places_;                 ///< Where the points of the pass are.
  MeanTable means_;                    ///< Of touched cells; not a number where nothing is left.
  std::unique_ptr<LabelVotes> votes_;  ///< Of `MapCells::mixed`; null: labels are those of truth.
  std::int64_t mixed_label_ties_ = 0;
};

}  // namespace raymoval::erasor
