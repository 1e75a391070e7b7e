// SPDX-License-Identifier: MIT
#include "benchmark/tables/published_columns.h"

#include <filesystem>
#include <map>

#include "benchmark/suite/shipped_suites.h"
#include "core/error.h"
#include "eval/protocol_registry.h"
#include "eval/published/published.h"

namespace raymoval {
namespace {

/// The published tables that runs are set beside, by protocol.
const std::map<std::string, PublishedForm>& published_forms() {
  static const std::map<std::string, PublishedForm> forms = {
      {"erasor",
       {.sequence_prefix = "kitti-",
        .note = "Values as printed (Raymoval paper, Table 2); the means are computed from them, "
                "since two of the printed means are misprints.",
        .files = {"raymoval_table2.json"}}},
      {"dynamicmap",
       {.title = "Published, DynamicMap benchmark",
        .sequence_prefix = "kth-",
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

}  // namespace

const std::vector<Rate>* OutsideColumn::find(const std::string& name) const {
  const std::string prefix = published_form(protocol).sequence_prefix;
  for (const auto& [sequence, values] : sequences) {
    if (sequence == name || prefix + sequence == name) return &values;
  }
  return nullptr;
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
        column_of(row.method, entry.name, columns).sequences.emplace_back(row.sequence, rates);
      }
    }
  }
  return columns;
}

}  // namespace raymoval
