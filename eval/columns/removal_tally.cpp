// SPDX-License-Identifier: MIT
#include "eval/columns/removal_tally.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "eval/points/checked_scan.h"
#include "eval/points/labelled_voxels.h"
#include "eval/points/scan_loops.h"

namespace raymoval {
namespace {

template <std::size_t Bands>
std::size_t band_of(const std::array<double, Bands>& edges, double value) {
  const auto above = std::upper_bound(edges.begin() + 1, edges.end(), value);
  return static_cast<std::size_t>(above - edges.begin()) - 1;
}

template <std::size_t Bands>
std::string band_name(const std::array<double, Bands>& edges, std::size_t band) {
  if (band + 1 == Bands) return number_text(edges[band]) + " m and more";
  if (std::isinf(edges[band])) return "below " + number_text(edges[band + 1]) + " m";
  return number_text(edges[band]) + "-" + number_text(edges[band + 1]) + " m";
}

void count(const Eigen::Vector3d& point, bool removed, ClassTally& tally) {
  const PointTally one{1, removed ? 1 : 0};
  tally.by_range[band_of(kRangeEdges, point.norm())] += one;
  tally.by_height[band_of(kHeightEdges, point.z() + kHeightOffset)] += one;
}

RemovalTally tally_scan(const EvaluationInput& input, const LabelClasses& classes,
                        const MaskStore& masks, std::size_t index) {
  constexpr double kCrop = kMinimumHorizontalRange * kMinimumHorizontalRange;
  const CheckedScan loaded = load_checked(input, &masks, index);
  RemovalTally tally;
  for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
    const Eigen::Vector3d point = loaded.scan.points[i].cast<double>();
    const LabelClass label_class = classes.of(loaded.labels[i]);
    if (label_class == LabelClass::kIgnored || !input.range_m.contains(point.norm()) ||
        point.head<2>().squaredNorm() < kCrop) {
      continue;
    }
    ClassTally& of_class = tally.classes[semantic_id(loaded.labels[i])];
    of_class.moving = label_class == LabelClass::kMoving;
    count(point, loaded.removed(i), of_class);
  }
  return tally;
}

void add(const RemovalTally& scan, RemovalTally& all) {
  for (const auto& [id, from] : scan.classes) {
    ClassTally& to = all.classes[id];
    to.moving = from.moving;
    for (std::size_t i = 0; i < kRangeBands; ++i) to.by_range[i] += from.by_range[i];
    for (std::size_t i = 0; i < kHeightBands; ++i) to.by_height[i] += from.by_height[i];
  }
}

}  // namespace

PointTally& PointTally::operator+=(const PointTally& other) {
  points += other.points;
  removed += other.removed;
  return *this;
}

PointTally ClassTally::all() const {
  PointTally sum;
  for (const PointTally& band : by_range) sum += band;
  return sum;
}

std::string range_band_name(std::size_t band) {
  return band_name(kRangeEdges, band);
}

std::string height_band_name(std::size_t band) {
  return band_name(kHeightEdges, band);
}

RemovalTally tally_removals(const EvaluationInput& input, const MaskStore& masks) {
  check_input(input, "columns");
  check_mask_count(input, masks);
  const LabelClasses classes(input.label_rule);
  std::vector<RemovalTally> scans(input.scans->size());
  for_each_scan(input, "points by class",
                [&](std::size_t i) { scans[i] = tally_scan(input, classes, masks, i); });
  RemovalTally all;
  all.label_rule = input.label_rule;
  for (const RemovalTally& scan : scans) add(scan, all);
  return all;
}

}  // namespace raymoval
