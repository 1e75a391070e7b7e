// SPDX-License-Identifier: MIT
#include "benchmark/tables/published_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "benchmark/suite/shipped_suites.h"
#include "benchmark/tables/table_options.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/frames.h"
#include "eval/protocol_registry.h"
#include "eval/published/published.h"

namespace raymoval {
namespace {

/// The published tables that runs are set beside, by protocol.
const std::map<std::string, PublishedForm>& published_forms() {
  static const std::map<std::string, PublishedForm> forms = {
      {"erasor",
       {.sequence_prefix = "kitti-",
        .frames = {{"00", "4390:4530:2"},
                   {"01", "150:250:1"},
                   {"02", "860:950:2"},
                   {"05", "2350:2670:2"},
                   {"07", "630:820:2"}},
        .note = "Values as printed (Raymoval paper, Table 2); the means are computed from them, "
                "since two of the printed means are misprints.",
        .files = {"raymoval_table2.json"}}},
      {"dynamicmap",
       {.title = "Published, DynamicMap benchmark",
        .sequence_prefix = "kth-",
        .frames = {{"00", "4390:4530:1"}, {"05", "2350:2670:1"}},
        .decimals = 2,
        .comparable = false,
        .note =
            "As printed by the benchmark, DUFOMap and BeautyMap, to 2 decimals; -: not printed. "
            "KITTI at every frame, without a range limit; which frames lie behind 01 is not "
            "known. More in results/published/.",
        .files = {"dynamicmap_benchmark.json", "dynamicmap_other_methods.json",
                  "dynamicmap_claims.json"}}},
      {"mos",
       {.title = "Published, moving-object segmentation",
        .decimals = 1,
        .comparable = false,
        .note = "As printed by HMM-MOS, with one decimal; -: not printed. More in "
                "results/published/.",
        .files = {"mos_hmm_mos.json"}}}};
  return forms;
}

OutsideColumn& column_of(const std::string& method, const std::string& protocol,
                         std::vector<OutsideColumn>& columns) {
  const std::string heading = method + " (published)";
  for (OutsideColumn& column : columns) {
    if (column.heading == heading && column.protocol == protocol) return column;
  }
  columns.push_back({heading, protocol, {}});
  return columns.back();
}

/// Why rows of papers are not comparable with a sequence of the same name; empty if they are.
std::string why_not_beside(const PublishedForm& form, const std::string& sequence,
                           const DataRecord* data) {
  const auto known = form.frames.find(sequence);
  if (known == form.frames.end()) return "which frames the papers used is not known";
  const FrameRange range = parse_frame_range(known->second);
  const auto scans = static_cast<std::size_t>((*range.last - *range.first) / range.stride + 1);
  const std::string expected =
      fmt::format("the papers have frames {} ({} scans), ", known->second, scans);
  if (data == nullptr) return expected + "and no cell has read its scans";
  const std::string ends = fmt::format("{}:{}:", *range.first, *range.last);
  if (data->frames.starts_with(ends) && data->scans == scans) return "";
  return expected +
         fmt::format("and this run has {} ({})", data->frames, counted_text(data->scans, "scan"));
}

}  // namespace

const std::vector<Rate>* OutsideColumn::find(std::string OutsideRow::*which,
                                             const std::string& name) const {
  const auto found = std::ranges::find(rows, name, which);
  return found == rows.end() ? nullptr : &found->rates;
}

std::vector<std::string> set_beside(std::vector<OutsideColumn>& columns,
                                    const RunResults& results) {
  std::vector<std::string> kinds, lines;
  for (const std::string& protocol : results.protocols) add_once(kinds, results.kind_of(protocol));
  for (const std::string& sequence : results.sequences) {
    bool any = false;
    std::vector<std::string> reasons;
    for (OutsideColumn& column : columns) {
      const PublishedForm& form = published_form(column.protocol);
      for (OutsideRow& row : column.rows) {
        const bool named =
            row.sequence == sequence || form.sequence_prefix + row.sequence == sequence;
        if (!named || !is_among(kinds, column.protocol)) continue;
        const std::string why = why_not_beside(form, row.sequence, results.data_of(sequence));
        if (why.empty()) row.beside = sequence;
        any = any || why.empty();
        if (!why.empty()) add_once(reasons, why);
      }
    }
    if (reasons.empty()) reasons = {"no paper has numbers for it by " + join(kinds, " or ")};
    if (!any) lines.push_back(sequence + ": " + join(reasons, "; "));
  }
  return lines;
}

const PublishedForm& published_form(const std::string& protocol) {
  static const PublishedForm plain;
  const auto found = published_forms().find(protocol);
  return found == published_forms().end() ? plain : found->second;
}

std::vector<OutsideColumn> published_columns() {
  const std::filesystem::path folder = shipped_data("published");
  if (folder.empty()) throw DataError("published tables: " + missing_data("published"));
  std::vector<OutsideColumn> columns;
  for (const ProtocolEntry& entry : protocol_entries()) {
    for (const char* file : published_form(entry.name).files) {
      for (const PublishedRow& row : load_published_table(folder / file).rows) {
        std::vector<Rate> rates;
        for (const auto& [name, value] : row.values) rates.push_back({name, value});
        column_of(row.method, entry.name, columns).rows.push_back({row.sequence, rates});
      }
    }
  }
  return columns;
}

}  // namespace raymoval
