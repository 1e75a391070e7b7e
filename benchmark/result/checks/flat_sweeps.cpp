// SPDX-License-Identifier: MIT
#include "benchmark/result/checks/flat_sweeps.h"

#include <algorithm>
#include <map>
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

/// What cells of a sequence removed that differ in one parameter only, by the values of the others.
using Groups = std::map<Values, std::vector<std::string>>;

Groups groups_of(const RunResults& results, const std::string& sweep, const std::string& key,
                 const std::string& sequence) {
  Groups groups;
  for (const SweptCell& swept : results.sweeps) {
    if (swept.sweep() != sweep) continue;
    Values others;
    for (const auto& pair : swept.values) {
      if (pair.first != key) others.push_back(pair);
    }
    const std::string digest = digest_of(results, sequence, swept.cell);
    if (!digest.empty()) groups[others].push_back(digest);
  }
  return groups;
}

/// Whether all cells of each group removed the same; nothing where there is nothing to compare.
std::optional<bool> is_flat(const Groups& groups) {
  bool compared = false;
  for (const auto& [others, digests] : groups) {
    if (digests.size() < 2) continue;
    compared = true;
    if (std::set<std::string>(digests.begin(), digests.end()).size() > 1) return false;
  }
  return compared ? std::optional<bool>(true) : std::nullopt;
}

std::vector<std::string> swept_keys(const RunResults& results, const std::string& sweep) {
  std::vector<std::string> keys;
  for (const SweptCell& swept : results.sweeps) {
    if (swept.sweep() != sweep) continue;
    for (const auto& [key, value] : swept.values) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

std::size_t value_count(const RunResults& results, const std::string& sweep,
                        const std::string& key) {
  std::set<std::string> values;
  for (const SweptCell& swept : results.sweeps) {
    if (swept.sweep() != sweep) continue;
    for (const auto& [name, value] : swept.values) {
      if (name == key) values.insert(value);
    }
  }
  return values.size();
}

}  // namespace

std::vector<std::string> flat_sweeps(const RunResults& results, const std::string& sweep) {
  std::vector<std::string> lines;
  for (const std::string& key : swept_keys(results, sweep)) {
    std::vector<std::string> flat;
    std::size_t compared = 0;
    for (const std::string& sequence : results.sequences) {
      const auto found = is_flat(groups_of(results, sweep, key, sequence));
      compared += found ? 1 : 0;
      if (found.value_or(false)) flat.push_back(sequence);
    }
    if (flat.empty()) continue;
    lines.push_back(key + " made no difference" +
                    (flat.size() == compared ? "" : " on " + join(flat)) + ": with each of its " +
                    std::to_string(value_count(results, sweep, key)) +
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
