// SPDX-License-Identifier: MIT
#include "benchmark/published_columns.h"

#include <filesystem>

#include "benchmark/shipped_data.h"
#include "core/error.h"
#include "eval/published.h"

namespace raymoval {
namespace {

constexpr const char* kTable = "raymoval_table2.json";

std::filesystem::path published_file() {
  const std::filesystem::path folder = shipped_data("published");
  if (folder.empty()) throw DataError("published tables: " + missing_data("published"));
  return folder / kTable;
}

OutsideColumn& column_of(const std::string& method, std::vector<OutsideColumn>& columns) {
  const std::string heading = method + " (published)";
  for (OutsideColumn& column : columns) {
    if (column.heading == heading) return column;
  }
  columns.push_back({heading, {}});
  return columns.back();
}

}  // namespace

std::vector<OutsideColumn> published_columns() {
  std::vector<OutsideColumn> columns;
  for (const PublishedRow& row : load_published_table(published_file()).rows) {
    column_of(row.method, columns).sequences.emplace_back(row.sequence, row.values);
  }
  return columns;
}

}  // namespace raymoval
