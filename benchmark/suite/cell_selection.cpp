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

std::vector<bool> select_cells(const std::vector<std::string>& only,
                               const std::vector<std::string>& cells, const std::string& of) {
  std::vector<bool> chosen(cells.size(), only.empty());
  for (const std::string& pattern : only) {
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
  return chosen;
}

}  // namespace raymoval
