// SPDX-License-Identifier: MIT
#include "benchmark/cli/commands/score_record.h"

#include <fmt/format.h>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// "PR 99.422 (99.131 to 99.689)".
std::string rate_line(const Rate& rate, const ProtocolResult& result) {
  std::string text = "  " + rate.name + " ";
  if (!rate.value) return text + "n/a (" + rate.undefined_reason + ")\n";
  text += rate_text(rate.name, *rate.value);
  if (!result.intervals) return text + "\n";
  for (const Interval& interval : result.intervals->rates) {
    if (interval.name != rate.name || !interval.low || !interval.high) continue;
    text += " (" + rate_text(rate.name, *interval.low) + " to " +
            rate_text(rate.name, *interval.high) + ")";
  }
  return text + "\n";
}

std::string result_text(const std::string& name, const ProtocolResult& result) {
  std::string text = "protocol " + name + "\n";
  for (const auto& [count, value] : result.counts) {
    text += "  " + count + " " + std::to_string(value) + "\n";
  }
  for (const Rate& rate : result.rates) text += rate_line(rate, result);
  for (const std::string& warning : result.warnings) text += "  warning: " + warning + "\n";
  return text;
}

/// Columns without a band, as "precision 61.662 (25796 of 41835)".
std::string columns_text(const std::vector<ColumnValue>& columns) {
  std::string text = "points\n";
  for (const ColumnValue& column : columns) {
    if (!parse_column_name(column.name).axis.empty()) continue;
    const auto percent = column.share.percent();
    text += "  " + column.name + " " +
            (percent ? fixed_text(*percent, 3) + " (" + std::to_string(column.share.part) + " of " +
                           std::to_string(column.share.whole) + ")"
                     : "n/a (" + column.undefined_reason + ")") +
            "\n";
  }
  return text;
}

std::string cloud_text(const CloudRecord& cloud) {
  std::string text = fmt::format(
      "cloud of {} points: labels by nearest neighbour, points present within 0.05 m; "
      "not to be compared with scores by index\n",
      grouped_text(cloud.points));
  for (const std::string& warning : cloud.warnings) text += "  warning: " + warning + "\n";
  return text;
}

std::string oracle_text(const ProtocolResult& result) {
  std::string text = "  the oracle's cloud, scored in the same way:";
  for (const Rate& rate : result.rates) {
    text += " " + rate.name + " " + (rate.value ? rate_text(rate.name, *rate.value) : "n/a");
  }
  return text + "\n";
}

/// Why a cloud may be better by some rates than one without a single mistake; empty if it is not.
std::string above_oracle_text(const ProtocolResult& result, const ProtocolResult& oracle) {
  std::vector<std::string> above;
  for (const Rate& rate : result.rates) {
    const auto perfect = oracle.rate(rate.name);
    if (!rate.value || !perfect) continue;
    const double gain = *rate.value - *perfect;
    if (rate_spec(rate.name).higher_is_better ? gain > 0.0 : gain < 0.0) above.push_back(rate.name);
  }
  if (above.empty()) return "";
  return "  " + join(above) +
         " above the oracle's: that is no upper limit. The oracle keeps every static point; where "
         "one stands\n  beside a moving one, that one counts as kept, and thinning puts means "
         "where no point was.\n";
}

}  // namespace

std::string score_text(const ScoreRecord& record) {
  std::string text = record.cloud ? cloud_text(*record.cloud) : "";
  for (const ScoredProtocol& scored : record.protocols) {
    text += result_text(scored.protocol.name, scored.result);
    if (!scored.oracle) continue;
    text += oracle_text(*scored.oracle) + above_oracle_text(scored.result, *scored.oracle);
  }
  return text + columns_text(record.columns.values);
}

}  // namespace raymoval
