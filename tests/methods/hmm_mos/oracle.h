// SPDX-License-Identifier: MIT
// HMM-MOS written straight from its twelve steps with plain sets and lists: slow and plain.
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/hmm_mos/hmm_mos.h"

namespace raymoval::hmm_mos_test {

using namespace hmm_mos_method;

using Cell = std::array<int, 3>;
using Cells = std::set<Cell>;

enum class State { kUnobserved, kOccupied, kFree };

/// A voxel of the map.
struct Believed {
  Eigen::Vector3d belief = {1.0, 0.0, 0.0};  ///< Unobserved, occupied, free.
  State state = State::kUnobserved;
  int change = -1, seen = -1;  ///< Numbers of scans; -1 is never.
};

class Oracle {
 public:
  explicit Oracle(const Parameters& parameters) : p_(parameters) {}

  /// Takes the next scan in.
  void add(const Scan& scan);
  /// The online answer for the scan that was added last.
  [[nodiscard]] Mask mask(const Scan& scan) const;
  /// Whether the last known state of a point's voxel was free.
  [[nodiscard]] Mask last_free(const Scan& scan) const;

  // What the steps found out about the last scan.
  Cells occupied, observed, dynamic;
  std::map<Cell, int> scores;  ///< After the median.
  std::map<Cell, int> sums;    ///< By occupied voxel.
  double threshold = 0.0;
  bool has_threshold = false;

  std::map<Cell, Believed> map;
  std::map<Cell, State> last_known;  ///< Of cells that are or were in the map.

  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& world) const;
  /// The voxels on the line of whole numbers between two, both ends included.
  static std::vector<Cell> line(const Cell& from, const Cell& to);
  /// Steps 4 for one voxel, with a squared distance in metres.
  void observe(const Cell& cell, double squared_distance);

 private:
  [[nodiscard]] Eigen::Vector3d position(const Cell& cell) const;
  void find_cells(const Scan& scan);
  [[nodiscard]] double squared_distance(const Cell& cell) const;
  void forget(const Eigen::Vector3d& sensor);
  [[nodiscard]] int score(const Cell& cell) const;
  [[nodiscard]] int median(const Cell& cell, const std::map<Cell, int>& raw) const;
  void find_threshold();
  void find_dynamic();

  Parameters p_;
  int now_ = -1;
  Cells ends_;    ///< What is occupied, and what is so beyond the range.
  Cells before_;  ///< The same of the scan before.
  std::deque<std::map<Cell, int>> history_;
};

}  // namespace raymoval::hmm_mos_test
