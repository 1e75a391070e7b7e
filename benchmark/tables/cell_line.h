// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "benchmark/result/cell.h"

namespace raymoval {

/// The lines that a run logs, one for each cell, with aligned columns.
class CellLines {
 public:
  /// @param sequences,methods names in the run
  /// @param cells total number of cells
  CellLines(const std::vector<std::string>& sequences, const std::vector<std::string>& methods,
            std::size_t cells);

  /// "[ 3/52] town raymoval:offline F1 0.9221 4.2 ms PR 99.926 RR 85.361", of at most 100
  /// characters: the rate that methods are ranked by, the time per scan, then as many other main
  /// rates as fit; or the error.
  /// @param number of the cell, from 1
  /// @param kept whether an earlier run made the cell
  [[nodiscard]] std::string line(std::size_t number, const Cell& cell, bool kept = false) const;

 private:
  std::size_t cells_, sequence_width_ = 0, method_width_ = 0;
};

}  // namespace raymoval
