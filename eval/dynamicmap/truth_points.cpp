// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/truth_points.h"

#include <limits>

#include "core/error.h"
#include "eval/points/scan_loops.h"

namespace raymoval::dynamicmap {

PointCounts& PointCounts::operator+=(const PointCounts& other) {
  static_points += other.static_points;
  dynamic_points += other.dynamic_points;
  ego += other.ego;
  out_of_range += other.out_of_range;
  ignored += other.ignored;
  return *this;
}

void check_not_empty(const PointCounts& points) {
  if (points.static_points + points.dynamic_points > 0) return;
  throw DataError("nothing to score against: " + std::to_string(points.out_of_range) +
                  " points are out of range and " + std::to_string(points.ignored) +
                  " have ignored labels; expected at least one that is left. Check range_m, "
                  "maximum_range and the label rule.");
}

TruthPoints::TruthPoints(const EvaluationInput& input, double maximum_range, double ego_range)
    : input_(input),
      classes_(input.label_rule),
      maximum_range_(maximum_range > 0.0 ? maximum_range : std::numeric_limits<double>::infinity()),
      ego_range_(ego_range) {
  // If 0 and 1 are the classes, as in the benchmark's files, the rule for the ego vehicle would
  // destroy the truth.
  if (classes_.moving(0) || classes_.moving(1)) ego_range_ = 0.0;
}

Kind TruthPoints::kind_of(const Eigen::Vector3f& point, std::uint32_t word,
                          PointCounts& counts) const {
  const double range = point.cast<double>().norm();
  if (!input_.range_m.contains(range) || range >= maximum_range_) {
    ++counts.out_of_range;
    return Kind::kOutOfRange;
  }
  const LabelClass label_class = classes_.of(word);
  if (label_class == LabelClass::kIgnored) {
    ++counts.ignored;
    return Kind::kIgnored;
  }
  const bool ego =
      label_class == LabelClass::kStatic && semantic_id(word) <= 1 && range < ego_range_;
  counts.ego += ego ? 1 : 0;
  const bool moving = ego || label_class == LabelClass::kMoving;
  ++(moving ? counts.dynamic_points : counts.static_points);
  return moving ? Kind::kDynamic : Kind::kStatic;
}

std::vector<PointCounts> TruthPoints::count(const std::string& task) const {
  std::vector<PointCounts> counts(input_.scans->size());
  for_each_scan(input_, task, [&](std::size_t i) {
    counts[i] =
        visit_scan(load_checked(input_, nullptr, i), [](std::size_t, const Scan&, Kind, bool) {});
  });
  PointCounts all;
  for (const PointCounts& scan : counts) all += scan;
  check_not_empty(all);
  return counts;
}

}  // namespace raymoval::dynamicmap
