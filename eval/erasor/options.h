// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::erasor {

enum class LabelRuleOption { kBoth, kGeometry };
enum class MatchingOption { kRadius, kSameCell };
enum class LabelMode { kIndex, kNearest };
enum class FrameOption { kSequence, kErasor };

/// Options of the protocol; the defaults give the published numbers.
struct Options {
  double voxel_size = 0.2;
  double minimum_horizontal_range = 2.7;
  double lift = 1.73;
  FrameOption frame = FrameOption::kSequence;  ///< See `erasor_pose`.
  bool truck_is_moving = true;
  bool ignore_0_1 = false;
  LabelRuleOption label_rule = LabelRuleOption::kBoth;
  MatchingOption matching = MatchingOption::kRadius;
  LabelMode label_mode = LabelMode::kIndex;
};

const ParameterTable<Options>& option_table();

}  // namespace raymoval::erasor
