// SPDX-License-Identifier: MIT
#include "methods/dufomap/parameters.h"

namespace raymoval::dufomap_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

Table make_table() {
  Table table;
  table
      .number("voxel_size", &P::voxel_size,
              {"m", 0.02, 2, "v; 'resolution' of the public configuration", "Edge of a voxel."})
      .number("hit_extension", &P::hit_extension,
              {"m", 0, 5, "d_s; 'inflate_hits_dist'",
               "Every hit reaches back so far along its beam: the sensor's range noise."})
      .integer("unknown_inflation", &P::unknown_inflation,
               {"voxels", 0, 8, "d_p; 'inflate_unknown'",
                "A void needs all voxels within this distance (Chebyshev) seen free by the same "
                "scan: the pose error."})
      .flag("compensate_inflation", &P::compensate_inflation,
            {.source = "'inflate_unknown_compensation'",
             .sentence = "Beams run on behind their end until they have advanced d_p voxels along "
                         "one axis, so that the inflation does not eat the free side of surfaces.",
             .acts_when = "unknown_inflation > 0"})
      .flag("pass_through_hits", &P::pass_through_hits,
            {.source = "'ray_passthrough_hits'",
             .sentence = "Beams go on through voxels that other beams hit, to their own end."})
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 20, "'min_range'", "Points nearer to the sensor cast no beam."})
      .number(
          "maximum_range", &P::maximum_range,
          {"m", 0, 1000, "'max_range' (-1 there)", "Beams free no voxel beyond; 0 is no limit."})
      .flag("offline", &P::offline,
            {.source = "the paper's online variant",
             .sentence = "Answer for all points after the last scan instead of for each scan once "
                         "it is integrated."});
  return table;
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace raymoval::dufomap_method
