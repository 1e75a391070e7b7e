// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/options.h"

namespace raymoval::dynamicmap {
namespace {

const char* const kCode = "KTH DynamicMap benchmark, public code";

const ParameterNotes kMaximumRange = {
    "m", 0.0, 1e6, kCode,
    "Points at this 3-D distance from the sensor or beyond are on neither side; 0 = no limit, as "
    "in the published tables (the later tools use 50)."};
const ParameterNotes kEgoRange = {
    "m", 0.0, 1e6, kCode,
    "Points nearer than this with label 0 or 1 move (the ego vehicle); not where the label rule "
    "lets 0 or 1 move or ignores them."};

ParameterTable<Options> make_table() {
  ParameterTable<Options> table;
  table
      .number("distance", &Options::distance,
              {"m", 0.0, 10.0, kCode,
               "A point is gone if the nearest kept point is farther away than this."})
      .number("maximum_range", &Options::maximum_range, kMaximumRange)
      .number("ego_range", &Options::ego_range, kEgoRange)
      .flag(
          "ignored_in_estimate", &Options::ignored_in_estimate,
          {.source = kCode,
           .sentence =
               "Whether kept points of an ignored label can make a removed one near them present, "
               "as the estimate's labels are not read; false leaves them out."});
  return table;
}

ParameterTable<StrictOptions> make_strict_table() {
  ParameterTable<StrictOptions> table;
  table
      .number("voxel_size", &StrictOptions::voxel_size,
              {"m", 0.01, 100.0, "", "Edge of a cell; 0.1 m is twice the benchmark's distance."})
      .number("maximum_range", &StrictOptions::maximum_range, kMaximumRange)
      .number("ego_range", &StrictOptions::ego_range, kEgoRange);
  return table;
}

}  // namespace

const ParameterTable<Options>& option_table() {
  static const ParameterTable<Options> table = make_table();
  return table;
}

const ParameterTable<StrictOptions>& strict_option_table() {
  static const ParameterTable<StrictOptions> table = make_strict_table();
  return table;
}

}  // namespace raymoval::dynamicmap
