// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "methods/octomap/beam_tracer.h"
#include "methods/octomap/parameters.h"
#include "methods/remover.h"

namespace raymoval::octomap_method {

/// What a point of a scan says about its cell and its beam.
enum class PointRole : std::uint8_t {
  kSurface,  ///< Its cell is hit, and its beam is free.
  kGround,   ///< Its beam is free, and nothing is said about its cell.
  kNoise,    ///< Its cell is hit, and it has no beam.
  kLeftOut,  ///< It says nothing.
};

/// Computes the free and occupied cells of a scan. They depend on that scan alone; each cell counts
/// once however many beams cross it.
class ScanCells {
 public:
  /// @param context of the run, for its threads and its wish to stop; must outlive this object
  ScanCells(const Parameters& parameters, const RunContext& context);

  /// @param points end points in the tree's frame, metres
  /// @param roles one per point
  /// @param origin of the beams, in the same frame
  /// @throws Cancelled
  void compute(const std::vector<octomap::point3d>& points, const std::vector<PointRole>& roles,
               const octomap::point3d& origin);

  /// The cells are the union of these. Where a cell is both free and occupied, which of the two
  /// counts is not decided yet.
  [[nodiscard]] const std::vector<CellBlocks>& parts() const { return parts_; }
  void clear() {
    for (CellBlocks& part : parts_) part.clear();
  }

 private:
  /// A beam to `end`, whose cell is `last`.
  struct Beam {
    octomap::point3d end;
    CellCode last;
    bool hits;  ///< Its last cell is occupied.
  };
  void collect_beams(const std::vector<octomap::point3d>& points,
                     const std::vector<PointRole>& roles, const octomap::point3d& origin);
  void add_beam(const octomap::point3d& end, CellCode last, PointRole role,
                const octomap::point3d& origin);

  const Parameters* parameters_;
  const RunContext* context_;
  CellLattice lattice_;
  int threads_;
  std::vector<Beam> beams_;
  std::vector<CellBlocks> parts_;
};

}  // namespace raymoval::octomap_method
