// SPDX-License-Identifier: MIT
#include "benchmark/published_columns.h"

#include <filesystem>

#include "core/error.h"
#include "eval/published.h"

namespace raymoval {
namespace {

constexpr const char* kTable = "published/raymoval_table2.json";

std::filesystem::path published_file() {
  for (const std::filesystem::path place : {RAYMOVAL_SOURCE_RESULTS, RAYMOVAL_INSTALLED_RESULTS}) {
    std::error_code ignored;
    if (std::filesystem::exists(place / kTable, ignored)) return place / kTable;
  }
  throw DataError(std::string(kTable) + " is neither in the source folder (" +
                  RAYMOVAL_SOURCE_RESULTS + ") nor where it is installed (" +
                  RAYMOVAL_INSTALLED_RESULTS + "). Install raymoval again.");
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
