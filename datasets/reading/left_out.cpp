// SPDX-License-Identifier: MIT
#include "datasets/reading/left_out.h"

#include <set>
#include <tuple>

#include "core/text.h"
#include "datasets/clouds/file_source.h"
#include "datasets/ego/ego_region.h"

namespace raymoval {
namespace {

/// "12.3 % of the stored points", or the count if the share is tiny.
std::string share_text(std::uint64_t part, std::uint64_t whole) {
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  if (percent >= 1.0) return fixed_text(percent, 1) + " % of the stored points";
  if (percent >= 0.01) return fixed_text(percent, 2) + " % of the stored points";
  return grouped_text(part) + " of " + grouped_text(whole) + " stored points";
}

std::string ego_vehicle_line(const EgoFreeSource& source, const LeftOutPoints& points) {
  const EgoRegion& region = source.region();
  const bool estimated = source.asked().kind == EgoRegion::Kind::kEstimated;
  if (region.kind == EgoRegion::Kind::kNone) {
    return "--drop-ego auto: no points move with the sensor, so none is left out";
  }
  const std::string where =
      (region.kind == EgoRegion::Kind::kRadius ? "nearer than " + number_text(region.radius) + " m"
                                               : "in the box " + ego_region_text(region) + " m") +
      (estimated ? ", as estimated" : "");
  const std::string left = " on the ego vehicle (" + where + ") and ";
  if (points.ego_vehicle == 0) return "no point is" + left + "left out";
  return share_text(points.ego_vehicle, points.looked_at) + " are" + left + "are left out";
}

}  // namespace

LeftOutPoints left_out_points(const Sequence& sequence) {
  LeftOutPoints points;
  if (const EgoFreeSource* without_ego = ego_free_source(sequence)) {
    std::tie(points.looked_at, points.ego_vehicle) = without_ego->tally().total();
  }
  if (const auto* tallied = dynamic_cast<const TalliedSource*>(&stored_source(sequence))) {
    std::tie(points.stored, points.no_returns) = tallied->tally().total();
  }
  return points;
}

std::string empty_scans_line(const Sequence& sequence) {
  const auto* tallied = dynamic_cast<const TalliedSource*>(&stored_source(sequence));
  const auto empty = tallied == nullptr ? std::set<std::size_t>() : tallied->tally().empty();
  if (empty.empty()) return "";
  const FileScanSource* files = file_source(sequence);
  const std::size_t first = *empty.begin();
  return grouped_text(empty.size()) + " of " + counted_text(sequence.scans->size(), "scan") +
         " have no return, the first is " +
         (files != nullptr ? files->frames()[first].path.filename().string()
                           : "scan " + std::to_string(first)) +
         "; their masks are empty";
}

std::vector<std::string> left_out_lines(const Sequence& sequence) {
  const LeftOutPoints points = left_out_points(sequence);
  std::vector<std::string> lines;
  if (points.no_returns > 0) {
    lines.push_back(share_text(points.no_returns, points.stored) +
                    " are missing returns (NaN or at the origin) and are left out");
  }
  const EgoFreeSource* without_ego = ego_free_source(sequence);
  if (without_ego != nullptr && points.looked_at > 0) {
    lines.push_back(ego_vehicle_line(*without_ego, points));
  }
  return lines;
}

std::vector<std::string> lost_scan_lines(const Sequence& sequence) {
  std::vector<std::string> lines = sequence.damage;
  lines.insert(lines.end(), sequence.losses.begin(), sequence.losses.end());
  return lines;
}

std::vector<std::string> opening_lines(const Sequence& sequence) {
  std::vector<std::string> lines = sequence.damage;
  for (const auto* more : {&sequence.notes, &sequence.losses}) {
    lines.insert(lines.end(), more->begin(), more->end());
  }
  return lines;
}

}  // namespace raymoval
