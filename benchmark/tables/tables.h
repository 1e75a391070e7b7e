// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text/text_table.h"

namespace raymoval {

/// The tables of a run in the order in which they are shown: for each protocol the rates of every
/// method (best bold, second underlined) with their means, sweeps, the content of the removed
/// points, the controls, then the time of each stage (the paper's Table 3).
std::vector<TextTable> make_tables(const RunResults& results, const TableOptions& options = {});

/// The values of `TableOptions::what`: "accuracy", "sweeps", ... in the order of the tables.
std::vector<std::string> table_kinds();
/// The default tables of a document: the accuracy, or the sweeps if all methods are swept.
std::vector<std::string> latex_kinds(const RunResults& results);

/// Adds notes below a table on how its methods differ from their variants, and on which data they
/// were developed.
void add_method_notes(const RunResults& results, TextTable& table);

std::string tables_markdown(const RunResults& results, const std::vector<TextTable>& tables);
std::string tables_latex(const std::vector<TextTable>& tables);

/// The rates of the run's methods by a protocol. In the layout kMethodRows: a block for each
/// sequence, with papers' rows for the same sequence, then, for several sequences, a table of the
/// means. In the layout kSequenceRows: one table with both. None without methods or rates.
std::vector<TextTable> accuracy_tables(const RunResults& results, const std::string& protocol,
                                       const TableOptions& options);

/// The same for the controls, without marks and means, and whether they have their expected rates.
std::vector<TextTable> control_tables(const RunResults& results, const std::string& protocol,
                                      const TableOptions& options);

/// All numbers of the papers that have a sequence of the run, by the protocols of the run.
std::vector<TextTable> published_tables(const RunResults& results, const TableOptions& options);

/// The methods' confidences against the true shares: a table for each method with confidences, a
/// row for each bin.
std::vector<TextTable> reliability_tables(const RunResults& results);

/// The time per scan and the memory of a method, or `none` where they are not known.
std::vector<TableCell> cost_cells(const RunResults& results, const std::string& method,
                                  const char* none);

/// Whether the controls have their expected rates, in words.
std::string controls_text(const RunResults& results);

/// The curve of each sweep by each protocol, rate of kept against rate of removed points: a row for
/// each point, named by its parameters, a block for each sequence and one of the means. The best
/// values of the headline rate are marked.
std::vector<TextTable> sweep_tables(const RunResults& results, const TableOptions& options = {});

/// One table of the removed points, a row for each method: precision, recall, residue,
/// preservation, the moving class with the largest remaining share and the static class with the
/// largest lost share (of classes with at least `kNamedClassPoints` points). Counts are added up
/// over sequences. None without columns.
std::vector<TextTable> compact_column_tables(const RunResults& results);

/// A class of points, and the percentage of them with the right verdict.
struct ClassShare {
  std::string name;
  double percent = 0.0;
};
/// The class with the smallest share, of those with at least `kNamedClassPoints` points.
/// @param kind of the columns: "rejection" of moving classes, "preservation" of static ones
std::optional<ClassShare> worst_class(const MethodColumns& method, const std::string& kind);

inline constexpr std::int64_t kNamedClassPoints = 100;

/// The shares of moving points that stay and of static points that are removed, by range, height
/// and class: a row for each part, a column for each method. None without columns.
std::vector<TextTable> loss_tables(const RunResults& results);

/// Scores by points that are neither of a class nor of a range or height. None without columns.
std::vector<TextTable> column_tables(const RunResults& results);

/// The intervals of the rates, a table for each protocol that has any.
std::vector<TextTable> interval_tables(const RunResults& results);

}  // namespace raymoval
