// SPDX-License-Identifier: MIT
#include "eval/columns/removal_tally.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "eval/checked_scan.h"
#include "eval/scan_passes.h"

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

void count(const Eigen::Vector3d& point, std::size_t time, bool removed, ClassTally& tally) {
  const PointTally one{1, removed ? 1 : 0};
  tally.by_time[time] += one;
  tally.by_range[band_of(kRangeEdges, point.norm())] += one;
  tally.by_height[band_of(kHeightEdges, point.z() + kHeightOffset)] += one;
}

RemovalTally tally_scan(const EvaluationInput& input, const LabelClasses& classes,
                        const CheckedScan& loaded) {
  constexpr double kCrop = kMinimumHorizontalRange * kMinimumHorizontalRange;
  const std::size_t time = loaded.scan.index * kTimeBands / input.scans->size();
  RemovalTally tally;
  ClassTally* of_class = nullptr;  // Of the last point counted: neighbours often share it.
  std::uint16_t id = 0;
  PointTally* of_object = nullptr;  // Likewise.
  std::uint32_t object = 0;
  for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
    const Eigen::Vector3d point = loaded.scan.points[i].cast<double>();
    const LabelClass label_class = classes.of(loaded.labels[i]);
    if (label_class == LabelClass::kIgnored || !input.range_m.contains(point.norm()) ||
        point.head<2>().squaredNorm() < kCrop) {
      continue;
    }
    if (of_class == nullptr || id != semantic_id(loaded.labels[i])) {
      id = semantic_id(loaded.labels[i]);
      of_class = &tally.classes[id];
      of_class->moving = label_class == LabelClass::kMoving;
    }
    count(point, time, loaded.removed(i), *of_class);
    if (instance_id(loaded.labels[i]) == 0) continue;
    if (of_object == nullptr || object != loaded.labels[i]) {
      object = loaded.labels[i];
      of_object = &tally.objects[object];
    }
    *of_object += PointTally{1, loaded.removed(i) ? 1 : 0};
  }
  return tally;
}

void add(const RemovalTally& scan, RemovalTally& all) {
  for (const auto& [id, from] : scan.classes) {
    ClassTally& to = all.classes[id];
    to.moving = from.moving;
    for (std::size_t i = 0; i < kRangeBands; ++i) to.by_range[i] += from.by_range[i];
    for (std::size_t i = 0; i < kHeightBands; ++i) to.by_height[i] += from.by_height[i];
    for (std::size_t i = 0; i < kTimeBands; ++i) to.by_time[i] += from.by_time[i];
  }
  for (const auto& [word, points] : scan.objects) all.objects[word] += points;
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

std::string time_band_name(std::size_t band) {
  constexpr std::size_t kPercent = 100 / kTimeBands;
  return std::to_string(band * kPercent) + "-" + std::to_string((band + 1) * kPercent) + " %";
}

RemovalCount::RemovalCount(const EvaluationInput& input)
    : input_(input), classes_(input.label_rule) {
  check_input(input, "columns");
  all_.label_rule = input.label_rule;
}

bool RemovalCount::begin_pass(std::size_t slots) {
  const bool is_first = slots_.empty();
  slots_.resize(slots);
  return is_first;
}

void RemovalCount::read(const CheckedScan& scan, std::size_t slot) {
  slots_[slot] = tally_scan(input_, classes_, scan);
}

void RemovalCount::take(std::size_t slot) {
  add(slots_[slot], all_);
}

RemovalTally tally_removals(const EvaluationInput& input, const MaskStore& masks) {
  RemovalCount counted(input);
  run_passes(input, masks, {&counted});
  return counted.tally();
}

}  // namespace raymoval
