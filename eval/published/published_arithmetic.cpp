// SPDX-License-Identifier: MIT
#include <cmath>

#include "eval/averages.h"
#include "eval/published/published.h"
#include "eval/rates.h"

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

void check_row(const PublishedRow& row, Checks& checks) {
  const auto preservation = row.value("PR");
  const auto rejection = row.value("RR");
  if (preservation && rejection) {
    add(checks, row, row.sequence, "F1", "harmonic_mean",
        f1_from_percent(*preservation, *rejection));
  }
  const auto static_accuracy = row.value("SA");
  const auto dynamic_accuracy = row.value("DA");
  if (static_accuracy && dynamic_accuracy) {
    add(checks, row, row.sequence, "HA", "harmonic_mean",
        harmonic_mean(*static_accuracy, *dynamic_accuracy));
    add(checks, row, row.sequence, "AA", "geometric_mean",
        std::sqrt(*static_accuracy * *dynamic_accuracy));
  }
}

/// Rates of a method's rows. F1 is taken from PR and RR, which have more digits than the F1 that
/// is printed beside them.
std::vector<SegmentRates> segments_of(const PublishedTable& table, const std::string& method) {
  std::vector<SegmentRates> segments;
  for (const PublishedRow& row : table.rows) {
    if (row.method != method) continue;
    SegmentRates rates{row.value("PR"), row.value("RR"), std::nullopt};
    if (rates.PR && rates.RR) rates.F1 = f1_from_percent(*rates.PR, *rates.RR);
    segments.push_back(rates);
  }
  return segments;
}

void check_average(const PublishedTable& table, const PublishedRow& row, const std::string& place,
                   Checks& checks) {
  const AverageRates averages = average_rates(segments_of(table, row.method));
  add(checks, row, place, "PR", "mean", averages.PR.value);
  add(checks, row, place, "RR", "mean", averages.RR.value);
  add(checks, row, place, "F1", "mean_F1", averages.mean_F1.value);
  add(checks, row, place, "F1", "F1_of_means", averages.F1_of_means.value);
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
