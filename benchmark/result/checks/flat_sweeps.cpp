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

/// Whether all points of a sweep that differ only in parameter `k` removed the same points of a
/// sequence; no value if there is nothing to compare.
std::optional<bool> is_flat(const RunResults& results, const Sweep& sweep, std::size_t k,
                            const std::string& sequence) {
  std::map<Values, std::vector<std::string>> digests;  // By the values of the other parameters.
  for (const SweptCell* point : sweep.points) {
    const Cell* cell = results.find(sequence, point->cell);
    if (cell == nullptr || !cell->ok() || !cell->masks) continue;
    Values others = point->values;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    digests[others].push_back(cell->masks->digest);
  }
  std::optional<bool> flat;
  for (const auto& [others, group] : digests) {
    if (group.size() < 2) continue;
    flat = flat.value_or(true) && std::ranges::count(group, group.front()) == std::ssize(group);
  }
  return flat;
}

}  // namespace

std::vector<std::string> flat_sweeps(const RunResults& results, const Sweep& sweep) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < sweep.points.front()->values.size(); ++k) {
    std::set<std::string> values;
    for (const SweptCell* point : sweep.points) values.insert(point->values[k].second);
    std::vector<std::string> flat;
    std::size_t compared = 0;
    for (const std::string& sequence : results.sequences) {
      const auto found = is_flat(results, sweep, k, sequence);
      compared += found ? 1 : 0;
      if (found.value_or(false)) flat.push_back(sequence);
    }
    if (flat.empty()) continue;
    lines.push_back(sweep.points.front()->values[k].first + " had no effect" +
                    (flat.size() == compared ? "" : " on " + join(flat)) + ": with each of its " +
                    std::to_string(values.size()) +
                    " values exactly the same points were removed.");
  }
  return lines;
}

std::vector<std::string> flat_sweeps(const RunResults& results) {
  std::vector<std::string> lines;
  for (const Sweep& sweep : sweeps_of(results)) {
    for (const std::string& line : flat_sweeps(results, sweep)) {
      lines.push_back("sweep of " + sweep.name + ": " + line);
    }
  }
  return lines;
}

}  // namespace raymoval
