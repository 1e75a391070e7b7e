// SPDX-License-Identifier: MIT
#include "benchmark/tables/published_columns.h"

#include <filesystem>

#include "benchmark/suite/shipped_data.h"
#include "core/error.h"
#include "eval/published/published.h"

namespace raymoval {
namespace {

/// Tables that the shipped suites are set beside: Table 2 of the paper, on the segments of
/// `semantickitti`, and those of the DynamicMap benchmark, on the sequences of `kth`.
struct Source {
  const char* file;
  const char* protocol;
};
constexpr Source kSources[] = {{"raymoval_table2.json", "erasor"},
                               {"dynamicmap_benchmark.json", "dynamicmap"},
                               {"dynamicmap_other_methods.json", "dynamicmap"}};

std::filesystem::path published_folder() {
  std::filesystem::path folder = shipped_data("published");
  if (folder.empty()) throw DataError("published tables: " + missing_data("published"));
  return folder;
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

std::vector<OutsideColumn> published_columns() {
  const std::filesystem::path folder = published_folder();
  std::vector<OutsideColumn> columns;
  for (const Source& source : kSources) {
    for (const PublishedRow& row : load_published_table(folder / source.file).rows) {
      column_of(row.method, source.protocol, columns)
          .sequences.emplace_back(row.sequence, row.values);
    }
  }
  return columns;
}

}  // namespace raymoval
