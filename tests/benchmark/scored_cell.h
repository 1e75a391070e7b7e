// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/result/cell.h"
#include "benchmark/tables/text/text_table.h"

namespace raymoval::test {

inline Score score_by(const std::string& protocol, const std::vector<Rate>& rates) {
  return {{protocol, protocol, "1"}, {}, rates};
}

/// The cell of a method, `method:v`, with a score by the protocol `erasor`.
inline Cell scored_cell(const std::string& sequence, const std::string& method,
                        std::optional<double> pr, std::optional<double> rr,
                        std::optional<double> f1) {
  Cell cell{sequence, method, ""};
  cell.method.name = method;
  cell.method.variant = "v";
  cell.scores = {score_by("erasor", {{"PR", pr}, {"RR", rr}, {"F1", f1}})};
  return cell;
}

/// The same, timed.
inline Cell timed_cell(const std::string& sequence, const std::string& method, double pr, double rr,
                       double f1, double seconds) {
  Cell cell = scored_cell(sequence, method, pr, rr, f1);
  cell.measured.emplace().mean_seconds = seconds;
  return cell;
}

/// A cell that took too long.
inline Cell failed_cell(const std::string& sequence, const std::string& method,
                        const std::string& reason) {
  Cell cell = scored_cell(sequence, method, {}, {}, {});
  cell.fail(CellStatus::kTimeout, reason);
  return cell;
}

/// The rows of a table as "block, label: text, text". The best value has a '*', the second a '+'.
inline std::vector<std::string> rows_of(const TextTable& table) {
  std::vector<std::string> rows;
  for (const TableRow& row : table.rows) {
    std::string line = row.block.empty() ? row.label : row.block + ", " + row.label;
    for (const TableCell& cell : row.cells) {
      const char* mark = cell.mark == Mark::kBest ? "*" : cell.mark == Mark::kSecond ? "+" : "";
      line += (&cell == &row.cells.front() ? ": " : ", ") + cell.text + mark;
    }
    rows.push_back(line);
  }
  return rows;
}

}  // namespace raymoval::test
