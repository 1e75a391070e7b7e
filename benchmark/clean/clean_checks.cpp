// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_checks.h"

#include <fmt/format.h>

#include <vector>

#include "core/error.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/inspection/inspect.h"

namespace raymoval {
std::vector<Finding> check_data(const Sequence& sequence, const std::string& path, bool force,
                                Progress& progress, const std::atomic<bool>& cancel) {
  progress.begin("looking for mistakes in the data", 1);
  const InspectionReport report = inspect(sequence, &cancel);
  progress.end();
  std::vector<std::string> wrong;
  std::vector<Finding> warned;
  for (const Finding& finding : report.findings) {
    if (finding.severity == Severity::kNote || finding.consequence == Consequence::kUnused)
      continue;
    const bool refused = finding.consequence == Consequence::kRefused;
    if (refused && !force) {
      wrong.push_back(finding.sentence());
    } else {
      warned.push_back(finding);
      print_warning((refused ? "going on because of --force, in spite of " : "") +
                    finding.sentence());
    }
  }
  if (wrong.empty()) return warned;
  throw DataError(
      fmt::format("{} The map would be wrong, so nothing was written; `raymoval inspect {}` says "
                  "more, and --force cleans all the same.",
                  join(wrong, "\nraymoval: "), path));
}

void check_removed(std::uint64_t removed, std::uint64_t points, const std::string& path) {
  const std::string look = fmt::format(
      " Look at the poses, units and sensor (`raymoval inspect {}`), or try another --method.",
      path);
  if (removed == 0) {
    print_warning("nothing was removed: either nothing moves here, or the method cannot see it." +
                  look);
  } else if (2 * removed > points) {
    print_warning("more than half of all points were removed, which is much for things that move." +
                  look);
  }
}

}  // namespace raymoval
