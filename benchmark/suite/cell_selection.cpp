// SPDX-License-Identifier: MIT
#include "benchmark/suite/cell_selection.h"

#include <fnmatch.h>

#include <algorithm>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// A pattern describes "SEQUENCE/NAME" or one of the two.
bool fits(const std::string& pattern, const std::string& cell) {
  const std::size_t slash = cell.find('/');
  const auto matches = [&](const std::string& text) {
    return ::fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
  };
  return matches(cell) || matches(cell.substr(0, slash)) || matches(cell.substr(slash + 1));
}

}  // namespace

void parse_shard(const std::string& text, CellSelection& selection) {
  const auto parts = split(text, '/');
  const auto shard = parts.size() == 2 ? parse_number<std::size_t>(parts[0]) : std::nullopt;
  const auto shards = parts.size() == 2 ? parse_number<std::size_t>(parts[1]) : std::nullopt;
  if (!shard || !shards || *shard < 1 || *shard > *shards || *shards > 1'000'000) {
    throw UsageError("--shard " + text + ": expected I/N with I from 1 to N, such as 2/3.");
  }
  selection.shard = *shard;
  selection.shards = *shards;
}

std::vector<bool> select_cells(const CellSelection& selection,
                               const std::vector<std::string>& cells, const std::string& of) {
  std::vector<bool> chosen(cells.size(), selection.only.empty());
  for (const std::string& pattern : selection.only) {
    bool any = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!fits(pattern, cells[i])) continue;
      chosen[i] = any = true;
    }
    if (!any) {
      throw UsageError("--only '" + pattern + "' matches no cell of this " + of + "." +
                       suggestion(pattern, cells));
    }
  }
  const auto count = static_cast<std::size_t>(std::count(chosen.begin(), chosen.end(), true));
  std::size_t place = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!chosen[i]) continue;
    chosen[i] = place * selection.shards / count + 1 == selection.shard;
    ++place;
  }
  return chosen;
}

}  // namespace raymoval
