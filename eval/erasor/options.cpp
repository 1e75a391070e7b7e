// SPDX-License-Identifier: MIT
#include "eval/erasor/options.h"

namespace raymoval::erasor {
namespace {

const char* const kCode = "ERASOR, public evaluation code";
const char* const kPaper = "ERASOR, section III.B";

ParameterTable<Options> make_table() {
  ParameterTable<Options> table;
  table
      .number("voxel_size", &Options::voxel_size,
              {"m", 0.01, 100.0, kPaper,
               "Edge of a map voxel; a voxel matches within half its diagonal."})
      .number("minimum_horizontal_range", &Options::minimum_horizontal_range,
              {"m", 0.0, 1e6, kCode,
               "Points nearer to the sensor's z axis are on neither side (the ego vehicle)."})
      .number("lift", &Options::lift,
              {"m", -1e3, 1e3, kCode,
               "Added to z in the sensor frame, so that the ground lies near 0."})
      .choice("frame", &Options::frame,
              {{"sequence", FrameOption::kSequence}, {"erasor", FrameOption::kErasor}},
              {.source = kCode,
               .sentence =
                   "sequence: the frame of the poses, by the sequence's own calibration; erasor: "
                   "the first camera's, by one calibration for all, as ERASOR's map tool has it."})
      .flag("truck_is_moving", &Options::truck_is_moving,
            {.source = "ERASOR, README; its 2021 scripts leave id 258 out",
             .sentence = "Whether label id 258 (moving truck) moves; false counts it as static."})
      .flag("ignore_0_1", &Options::ignore_0_1,
            {.sentence = "Leaves static voxels labelled 0 or 1 (unlabelled, outlier) out of PR."})
      .choice("label_rule", &Options::label_rule,
              {{"both", LabelRuleOption::kBoth}, {"geometry", LabelRuleOption::kGeometry}},
              {.source = kCode,
               .sentence =
                   "both: a voxel stays only if its partner has its class; geometry: any partner."})
      .choice(
          "matching", &Options::matching,
          {{"radius", MatchingOption::kRadius}, {"same_cell", MatchingOption::kSameCell}},
          {.source = kCode,
           .sentence =
               "radius: the nearest estimate voxel within half a diagonal; same_cell: the one of "
               "the same cell."})
      .choice(
          "label_mode", &Options::label_mode,
          {{"index", LabelMode::kIndex}, {"nearest", LabelMode::kNearest}},
          {.source = kCode,
           .sentence =
               "index: estimate points keep their labels; nearest: labels are taken again from the "
               "nearest point of the dense map, as for maps without labels."});
  return table;
}

}  // namespace

const ParameterTable<Options>& option_table() {
  static const ParameterTable<Options> table = make_table();
  return table;
}

}  // namespace raymoval::erasor
