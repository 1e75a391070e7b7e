// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/report/html.h"
#include "benchmark/result/results.h"
#include "benchmark/tables/tables.h"
#include "methods/registry.h"

namespace raymoval {

// Each function returns the HTML below the heading of a section, or an empty text if it has no
// content.

/// The few numbers at the top: cells, sequences, failures, controls.
std::string facts_html(const ResultsRecord& record, const RunResults& results);
/// A row for each method with its means. `cells_html` has a row for every cell, and `accuracy_html`
/// has the tables of `raymoval table`.
std::string methods_html(const RunResults& results);
std::string accuracy_html(const RunResults& results, const std::vector<OutsideColumn>& published);
std::string cells_html(const RunResults& results);
/// The charts: PR against RR, accuracy against time, time of stages.
std::string charts_html(const RunResults& results);
/// The charts of each sequence: rates with their intervals, shares of points by range, time, class.
std::string sequences_html(const RunResults& results);
/// The methods' confidences against the true shares, as a chart and tables.
std::string confidence_html(const RunResults& results);
/// The shares of moving points that stay and of static points that are removed, by range, height
/// and class.
std::string losses_html(const RunResults& results);
/// The cells without a result, each with the reason and the end of its output.
std::string failures_html(const RunResults& results);
/// The effective parameters of each method, the sequences, protocols, program and machine.
std::string configuration_html(const ResultsRecord& record, const MethodRegistry& methods);
/// BibTeX of the methods and protocols, to copy.
std::string citations_html(const RunRecord& run, const MethodRegistry& methods);

}  // namespace raymoval
