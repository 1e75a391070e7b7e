// SPDX-License-Identifier: MIT
#include "eval/erasor/accumulate.h"

#include <algorithm>
#include <optional>

#include "core/parallel.h"
#include "core/text.h"

namespace raymoval::erasor {
namespace {

constexpr std::uint16_t kMovingTruck = 258;

Mask checked_mask(const MaskStore& masks, const Scan& scan, std::size_t index) {
  if (index >= masks.size() || !masks.has(index)) {
    throw MethodError("scan " + std::to_string(index) + " (" + scan.name +
                      ") has no mask: expected one per scan. The method must answer for every "
                      "scan, also for an empty one.");
  }
  Mask mask = masks.get(index);
  if (mask.size() != scan.size()) {
    throw MethodError("scan " + std::to_string(index) + " (" + scan.name + "): its mask has " +
                      grouped_text(mask.size()) + " values and the scan " +
                      grouped_text(scan.size()) +
                      " points; expected as many. Were the masks made from the same data?");
  }
  return mask;
}

std::vector<std::uint32_t> checked_labels(const LabelSource& source, const Scan& scan,
                                          std::size_t index) {
  std::vector<std::uint32_t> labels = source.labels(scan);
  if (labels.size() != scan.size()) {
    throw DataError("scan " + std::to_string(index) + " (" + scan.name + "): " +
                    grouped_text(labels.size()) + " labels for " + grouped_text(scan.size()) +
                    " points; expected as many. Check that labels and scans belong together.");
  }
  return labels;
}

/// Which of the counts a point belongs to.
std::int64_t PointCounts::*fate_of(const Eigen::Vector3d& point, LabelClass label_class,
                                   const EvaluationInput& input, const Options& options) {
  if (!input.range_m.contains(point.norm())) return &PointCounts::out_of_range;
  if (label_class == LabelClass::kIgnored) return &PointCounts::ignored;
  const double limit = options.minimum_horizontal_range;
  const double horizontal_squared = point.x() * point.x() + point.y() * point.y();
  return horizontal_squared < limit * limit ? &PointCounts::cropped : &PointCounts::evaluated;
}

struct PlacedScan {
  LabelledCloud cloud;  ///< World frame.
  PointCounts points;
};

PlacedScan place_scan(const EvaluationInput& input, const Options& options,
                      const LabelClasses& classes, const MaskStore* masks, std::size_t index) {
  const Scan scan = input.scans->load(index);
  const std::vector<std::uint32_t> labels = checked_labels(*input.labels, scan, index);
  const Mask mask = masks != nullptr ? checked_mask(*masks, scan, index) : Mask{};
  PlacedScan placed;
  placed.cloud.points.reserve(scan.size());
  placed.cloud.labels.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d point = scan.points[i].cast<double>();
    const auto fate = fate_of(point, classes.of(labels[i]), input, options);
    ++(placed.points.*fate);
    if (fate != &PointCounts::evaluated) continue;
    if (semantic_id(labels[i]) == kMovingTruck) ++placed.points.trucks;
    if (!mask.empty() && mask[i] != 0) {
      ++placed.points.removed;
      continue;
    }
    const Eigen::Vector3d lifted = point + Eigen::Vector3d(0.0, 0.0, options.lift);
    placed.cloud.points.push_back(scan.T_world_sensor * lifted);
    placed.cloud.labels.push_back(labels[i]);
  }
  return placed;
}

}  // namespace

PointCounts& PointCounts::operator+=(const PointCounts& other) {
  out_of_range += other.out_of_range;
  ignored += other.ignored;
  cropped += other.cropped;
  evaluated += other.evaluated;
  removed += other.removed;
  trucks += other.trucks;
  return *this;
}

LabelRule effective_rule(const LabelRule& rule, const Options& options) {
  LabelRule effective = rule;
  if (!options.truck_is_moving) std::erase(effective.moving, kMovingTruck);
  return effective;
}

DenseMap accumulate(const EvaluationInput& input, const Options& options,
                    const LabelClasses& classes, const MaskStore* masks, const std::string& task) {
  struct Part {
    LabelledVoxels voxels;
    PointCounts points;
  };
  const std::size_t scans = input.scans->size();
  if (input.progress != nullptr) input.progress->begin(task, scans);
  DenseMap dense;
  // A batch at a time: at most that many raw scans are in memory.
  const auto batch = static_cast<std::size_t>(std::max(1, input.threads)) * 4;
  for (std::size_t first = 0; first < scans; first += batch) {
    std::vector<Part> parts(std::min(batch, scans - first));
    parallel_for(input.threads, parts.size(), 1, [&](std::size_t i) {
      const PlacedScan placed = place_scan(input, options, classes, masks, first + i);
      parts[i] = {voxelise(placed.cloud, options.voxel_size, classes, 1), placed.points};
      if (input.progress != nullptr) input.progress->advance();
    });
    for (const Part& part : parts) {
      dense.cloud.append(part.voxels.cloud);
      dense.mixed_label_ties += part.voxels.mixed_label_ties;
      dense.points += part.points;
    }
  }
  if (input.progress != nullptr) input.progress->end();
  return dense;
}

}  // namespace raymoval::erasor
