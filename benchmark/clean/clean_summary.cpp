// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/inspection/inspect.h"

namespace raymoval {
namespace {

/// If a smaller share of the points is removed, hardly anything moves, or moving points are left.
constexpr double kFew = 0.001;

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  return percent_text(static_cast<double>(part) / static_cast<double>(whole), 2);
}

}  // namespace

InspectionReport check_data(const Sequence& sequence, const std::string& path, bool force,
                            const OpenContext& context) {
  context.progress->begin("checking the data", 1);
  InspectionReport report = inspect(sequence, context.threads, context.cancel);
  context.progress->end();
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
      print_warning((refused ? "continuing because of --force, in spite of " : "") +
                    finding.sentence());
    }
  }
  report.findings = std::move(warned);
  if (wrong.empty()) return report;
  throw DataError(
      fmt::format("{} The map would be wrong, so nothing was written; `raymoval inspect {}` shows "
                  "details, and --force cleans it nevertheless.",
                  join(wrong, "\nraymoval: "), path));
}

void check_removed(std::uint64_t removed, std::uint64_t points, const std::string& path) {
  const std::string look = fmt::format(
      " Check the poses, units and sensor (`raymoval inspect {}`), or try another --method.", path);
  if (removed == 0) {
    print_warning(
        "nothing was removed: either nothing moves here, or the method does not detect it." + look);
  } else if (2 * removed > points) {
    print_warning(
        "more than half of all points were removed, which is too much for moving objects." + look);
  }
}

void RangeShares::add(const Scan& scan, const Mask& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] > 1) continue;
    const float range = scan.points[i].norm();
    // Without a branch: ranges of neighbouring points differ too much for branch prediction.
    std::size_t band = 0;
    for (std::size_t b = 1; b < kBands.size(); ++b) {
      band += range >= static_cast<float>(kBands[b]) ? 1 : 0;
    }
    ++counts_[band].points;
    counts_[band].removed += mask[i];
  }
}

std::string RangeShares::table() const {
  std::string text =
      fmt::format("{:>9} {:>15} {:>13} {:>9}\n", "range", "points", "removed", "share");
  for (std::size_t band = 0; band < kBands.size(); ++band) {
    const Count& count = counts_[band];
    if (count.points == 0) continue;
    const std::string range = band + 1 < kBands.size()
                                  ? fmt::format("{}-{} m", kBands[band], kBands[band + 1])
                                  : fmt::format("{}+ m", kBands[band]);
    text += fmt::format("{:>9} {:>15} {:>13} {:>9}\n", range, grouped_text(count.points),
                        grouped_text(count.removed), share_text(count.removed, count.points));
  }
  return text;
}

std::vector<std::string> remedies(std::uint64_t removed, std::uint64_t points,
                                  const std::string& path, const std::string& method,
                                  const std::vector<Finding>& warned, bool is_seen) {
  std::vector<std::string> advice;
  if (!warned.empty()) {
    std::vector<std::string> names;
    for (const Finding& finding : warned) {
      if (std::find(names.begin(), names.end(), finding.check) == names.end()) {
        names.push_back(finding.check);
      }
    }
    advice.push_back("first correct the mistakes in the data: " + join(names) + ".");
  }
  const auto share =
      static_cast<double>(removed) / static_cast<double>(std::max<std::uint64_t>(points, 1));
  if (share < kFew && method != "raymoval_plus:offline") {
    advice.push_back(
        "little was removed: if moving objects are left, try --method raymoval_plus:offline, which "
        "removes most.");
  } else if (share < kFew) {
    advice.push_back(
        "little was removed: if moving objects are left, check the poses and units (`raymoval "
        "inspect " +
        path + "` with the same options).");
  }
  advice.push_back(
      "if parts of walls or ground are missing, the poses are wrong in most cases: `raymoval "
      "inspect " +
      path +
      "` with the same options; if points of the ego vehicle are left, try --drop-ego auto.");
  if (!is_seen) advice.push_back("look at the map with --html map.html or --picture map.png.");
  return advice;
}

}  // namespace raymoval
