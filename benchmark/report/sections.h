// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/report/html.h"
#include "benchmark/result/results.h"
#include "benchmark/tables/tables.h"
#include "eval/comparison/compare.h"
#include "methods/registry.h"

namespace raymoval {

/// What the sections of a report are made of.
struct ReportContent {
  const ResultsRecord* record = nullptr;  ///< Content of results.json.
  const RunResults* results = nullptr;    ///< The same as tables show it.
  std::vector<OutsideColumn> published;   ///< Papers' rows; may be empty.
};

// Each function returns the HTML below the heading of a section, or an empty text if there is
// nothing to say.

/// The few numbers at the top: cells, sequences, failures, controls.
std::string facts_html(const ReportContent& content);
/// A row for each method with its means. `cells_html` has a row for every cell, and `accuracy_html`
/// has the tables of `raymoval table`.
std::string methods_html(const ReportContent& content);
std::string accuracy_html(const ReportContent& content);
std::string cells_html(const ReportContent& content);
/// The charts: PR against RR, accuracy against time, time of stages.
std::string charts_html(const ReportContent& content);
/// What methods said of points against what came true, as a chart and tables.
std::string confidence_html(const ReportContent& content);
/// The shares of moving points that stay and of static points that are removed, by range, height
/// and class.
std::string losses_html(const ReportContent& content);
/// The cells without a result, each with the reason and the end of what it printed.
std::string failures_html(const ReportContent& content);
/// What changed against a reference run called `name`.
std::string comparison_html(const Comparison& comparison, const std::string& name);
/// The effective parameters of each method, the sequences, protocols, program and machine.
std::string configuration_html(const ReportContent& content, const MethodRegistry& methods);

}  // namespace raymoval
