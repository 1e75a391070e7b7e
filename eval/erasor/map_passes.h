// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "eval/erasor/accumulate.h"
#include "eval/erasor/options.h"
#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/cell_means.h"
#include "eval/lattice/label_votes.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// What makes a map of scans.
struct MapRules {
  const EvaluationInput& input;
  const Options& options;
  const LabelClasses& classes;
};

/// The cells of a sequence, whatever is removed of it.
struct MapCells {
  CellLattice all;                ///< Every cell that can hold a point of the dense map.
  std::vector<CellPoint> sorted;  ///< `all` by key.
  /// Cells in which the class of a voxel, or of a point of the dense map, hangs on which points are
  /// near: those within two cells of a point that moves, or is a truck. No point farther away can
  /// give its label: it would be over two half diagonals from the mean.
  CellLattice mixed;
  std::vector<CellLattice::Number> mixed_numbers;  ///< In `all`.
  CellLattice near_mixed;                          ///< `mixed` and the cells beside it.
};

/// Finds the cells of a sequence, in one pass.
class MapCellsPass : public ScanVisitor {
 public:
  explicit MapCellsPass(const MapRules& rules) : rules_(rules) {}
  bool begin_pass(std::size_t slots) override;
  void read(const CheckedScan& scan, std::size_t slot) override;
  void take(std::size_t slot) override;
  /// Called once, after the pass.
  [[nodiscard]] MapCells cells() const;

 private:
  struct Part {
    CellSet cells, moving;
  };
  MapRules rules_;
  std::vector<Part> slots_;
  Part all_;
};

/// The map of a sequence, or of what a mask leaves of it: what `voxelise` makes of the dense map,
/// bit by bit, without the dense map. Points are never kept: the first pass adds up each voxel's
/// mean, the second one lets the points of the dense map vote for labels. Both passes make the
/// points of the dense map again.
class MapPasses : public ScanVisitor {
 public:
  enum class Labels {
    kExact,    ///< Every voxel gets its label and the scan it is from.
    kClasses,  ///< Voxels outside of `MapCells::mixed` get any static label.
  };

  /// @param cells of the sequence; must outlive this object
  MapPasses(const MapRules& rules, const MapCells& cells, Labels labels);
  bool begin_pass(std::size_t slots) override;
  void read(const CheckedScan& scan, std::size_t slot) override;
  void take(std::size_t slot) override;

  [[nodiscard]] const PointCounts& points() const { return points_; }
  /// The voxels without `label_points`. Called once, after the last pass.
  /// @param scan_of_voxel for each voxel the scan whose point gave it its label, with `kExact`;
  ///   null: it is not asked for
  [[nodiscard]] LabelledVoxels finish(std::vector<std::uint32_t>* scan_of_voxel);

 private:
  using Number = CellLattice::Number;
  struct Offer {
    std::uint32_t voter;  ///< Number in `voters`.
    std::uint32_t word;
    double distance;
    bool moves;
  };
  struct Part {
    std::uint32_t scan = 0;
    PointCounts points;
    CellMeans cells;
    std::vector<std::pair<Number, Eigen::Vector3d>> means;  ///< In the order of the dense map.
    std::vector<Offer> offers;
    std::int64_t ties = 0;
  };

  void read_means(const PlacedScan& placed, Part& part) const;
  void read_offers(const PlacedScan& placed, Part& part) const;
  void offer_around(const Eigen::Vector3d& point, std::uint32_t word, CellLattice::Cursor& cursor,
                    Part& part) const;
  void end_sums();
  [[nodiscard]] const CellLattice& voters() const {
    return labels_ == Labels::kExact ? cells_.all : cells_.mixed;
  }
  /// The voter's number in `MapCells::all`.
  [[nodiscard]] Number number_of(std::uint32_t voter) const {
    return labels_ == Labels::kExact ? voter : cells_.mixed_numbers[voter];
  }

  MapRules rules_;
  const MapCells& cells_;
  Labels labels_;
  int pass_ = 0;
  std::vector<Part> slots_;
  PointCounts points_;
  std::int64_t ties_ = 0;
  std::vector<OffsetMean> sums_;        ///< By number in `MapCells::all`, in the first pass.
  std::vector<Eigen::Vector3d> means_;  ///< Afterwards; not a number where there is no point.
  std::unique_ptr<LabelVotes> votes_;
};

}  // namespace raymoval::erasor
