// SPDX-License-Identifier: MIT
#include "benchmark/result/checks/flat_sweeps.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/text.h"

namespace raymoval {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

/// Digest of the masks of a cell; empty if it has none.
std::string digest_of(const RunResults& results, const std::string& sequence,
                      const std::string& cell) {
  for (const ResultRow& row : results.rows) {
    if (row.sequence == sequence && row.cell == cell && row.status == "ok") return row.mask_digest;
  }
  return "";
}

/// Whether all points of a sweep that differ in `key` only removed the same on a sequence; nothing
/// where there is nothing to compare.
std::optional<bool> is_flat(const RunResults& results, const std::vector<SweptCell>& points,
                            const std::string& key, const std::string& sequence) {
  std::map<Values, std::vector<std::string>> digests;  // By the values of the other parameters.
  for (const SweptCell& point : points) {
    Values others = point.values;
    std::erase_if(others, [&](const auto& pair) { return pair.first == key; });
    const std::string digest = digest_of(results, sequence, point.cell);
    if (!digest.empty()) digests[others].push_back(digest);
  }
  std::optional<bool> flat;
  for (const auto& [others, group] : digests) {
    if (group.size() < 2) continue;
    flat = flat.value_or(true) && std::ranges::count(group, group.front()) == std::ssize(group);
  }
  return flat;
}

}  // namespace

std::vector<std::string> flat_sweeps(const RunResults& results, const std::string& sweep) {
  std::vector<SweptCell> points = results.sweeps;
  std::erase_if(points, [&](const SweptCell& point) { return point.sweep() != sweep; });
  std::vector<std::string> lines;
  for (const auto& [key, any] : points.empty() ? Values{} : points.front().values) {
    std::set<std::string> values;
    for (const SweptCell& point : points) {
      for (const auto& [name, value] : point.values) {
        if (name == key) values.insert(value);
      }
    }
    std::vector<std::string> flat;
    std::size_t compared = 0;
    for (const std::string& sequence : results.sequences) {
      const auto found = is_flat(results, points, key, sequence);
      compared += found ? 1 : 0;
      if (found.value_or(false)) flat.push_back(sequence);
    }
    if (flat.empty()) continue;
    lines.push_back(key + " made no difference" +
                    (flat.size() == compared ? "" : " on " + join(flat)) + ": with each of its " +
                    std::to_string(values.size()) +
                    " values exactly the same points were removed.");
  }
  return lines;
}

std::vector<std::string> flat_sweeps(const RunResults& results) {
  std::vector<std::string> lines;
  std::set<std::string> seen;
  for (const SweptCell& swept : results.sweeps) {
    if (!seen.insert(swept.sweep()).second) continue;
    for (const std::string& line : flat_sweeps(results, swept.sweep())) {
      lines.push_back("sweep of " + swept.sweep() + ": " + line);
    }
  }
  return lines;
}

}  // namespace raymoval
