// SPDX-License-Identifier: MIT
#include "eval/averages.h"
#include "eval/protocol_registry.h"
#include "eval/published/published.h"

namespace raymoval {
namespace {

using Checks = std::vector<ArithmeticCheck>;

/// Adds a comparison if both numbers are there.
void add(Checks& checks, const PublishedRow& row, const std::string& place,
         const std::string& metric, const std::string& rule, std::optional<double> recomputed) {
  const std::optional<double> printed = row.value(metric);
  if (!printed || !recomputed) return;
  checks.push_back({row.method, place, metric, rule, *printed, *recomputed});
}

/// What a formula gives for two printed numbers.
std::optional<double> combined(const RateFormula& formula, const PublishedRow& row) {
  const auto first = row.value(formula.first), second = row.value(formula.second);
  if (!first || !second) return std::nullopt;
  return formula.combine(*first, *second);
}

void check_row(const PublishedRow& row, Checks& checks) {
  for (const RateSpec& spec : rate_specs()) {
    if (!spec.formula) continue;
    add(checks, row, row.sequence, spec.name, spec.formula->rule, combined(*spec.formula, row));
  }
}

/// The values of a rate in a method's rows. A rate that follows from two others is computed from
/// them if tables show its value of means too: PR and RR have more digits than the F1 beside them.
SegmentValues segments_of(const PublishedTable& table, const std::string& method,
                          const std::string& rate) {
  const RateSpec spec = rate_spec(rate);
  const bool computed = spec.formula && spec.formula->shown_of_means;
  SegmentValues values;
  for (const PublishedRow& row : table.rows) {
    if (row.method != method) continue;
    values.push_back(computed ? combined(*spec.formula, row) : row.value(rate));
  }
  return values;
}

void check_average(const PublishedTable& table, const PublishedRow& row, const std::string& place,
                   Checks& checks) {
  for (const RateSpec& spec : rate_specs()) {
    const bool of_means = spec.formula && spec.formula->shown_of_means;
    const auto segments = [&](const std::string& rate) {
      return segments_of(table, row.method, rate);
    };
    add(checks, row, place, spec.name, of_means ? "mean_" + spec.name : "mean",
        mean_of(segments(spec.name)).value);
    if (!of_means) continue;
    const RateFormula& formula = *spec.formula;
    add(checks, row, place, spec.name, spec.name + "_of_means",
        combined_means(segments(formula.first), segments(formula.second), formula.combine).value);
  }
}

void check_total(const PublishedTable& table, const PublishedRow& total, Checks& checks) {
  for (const auto& [metric, printed] : total.values) {
    double sum = 0.0;
    for (const PublishedRow& row : table.rows) {
      if (row.method == total.method) sum += row.value(metric).value_or(0.0);
    }
    add(checks, total, "total", metric, "sum", sum);
  }
}

}  // namespace

std::vector<ArithmeticCheck> check_arithmetic(const PublishedTable& table) {
  Checks checks;
  for (const PublishedRow& row : table.rows) check_row(row, checks);
  for (const PublishedRow& row : table.averages_printed) {
    check_average(table, row, "average", checks);
  }
  for (const PublishedRow& row : table.averages_computed) {
    check_average(table, row, "average (computed)", checks);
  }
  for (const PublishedRow& row : table.totals_printed) check_total(table, row, checks);
  return checks;
}

}  // namespace raymoval
