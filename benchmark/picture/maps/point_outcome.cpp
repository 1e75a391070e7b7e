// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/point_outcome.h"

#include "core/error.h"
#include "core/progress.h"
#include "eval/columns/removal_tally.h"

namespace raymoval {

namespace {

struct OutcomeLook {
  Colour colour;
  const char* name;
};
/// In the order of `Outcome`.
constexpr std::array<OutcomeLook, kOutcomes> kLooks = {
    {{verdict_colours::kKeptStatic, "static, kept"},
     {verdict_colours::kTruePositive, "moving, removed"},
     {verdict_colours::kFalsePositive, "static, removed"},
     {verdict_colours::kFalseNegative, "moving, kept"}}};

}  // namespace

Colour outcome_colour(Outcome outcome) {
  return kLooks[static_cast<std::size_t>(outcome)].colour;
}

const char* outcome_name(Outcome outcome) {
  return kLooks[static_cast<std::size_t>(outcome)].name;
}

void for_each_shown_point(const Sequence& sequence, const ScanSource& scans,
                          const std::vector<MaskStore>& masks, const std::string& task,
                          const OpenContext& context, const VisitPoint& visit) {
  const LabelClasses classes(sequence.label_rule);
  const RangeLimits range_m(sequence.range_m);
  if (context.progress != nullptr) context.progress->begin(task, scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (context.cancel != nullptr && context.cancel->load()) throw Cancelled();
    const Scan scan = scans.load(i);
    const std::vector<std::uint32_t> labels = sequence.labels->labels(scan);
    std::vector<Mask> removed;
    for (const MaskStore& store : masks) removed.push_back(store.get(i));
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const Eigen::Vector3d point = scan.points[k].cast<double>();
      if (classes.of(labels[k]) == LabelClass::kIgnored || !range_m.contains(point.norm()) ||
          point.head<2>().norm() < kMinimumHorizontalRange) {
        continue;
      }
      const Eigen::Vector3d world = scan.T_world_sensor * point;
      const bool moving = classes.moving(labels[k]);
      for (std::size_t m = 0; m < masks.size(); ++m) {
        visit(m, {world, world.z() - scan.T_world_sensor.translation().z(),
                  outcome_of(moving, removed[m][k] != 0)});
      }
    }
    if (context.progress != nullptr) context.progress->advance();
  }
}

}  // namespace raymoval
