// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/parameters.h"

namespace raymoval::hmm_mos_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

void add_scan(Table& table) {
  table
      .number("voxel_size", &P::voxel_size,
              {"m", 0.05, 2, "all configurations of the public program (its README says 0.2)",
               "Edge of a voxel."})
      .number("min_range", &P::min_range,
              {"m", 0, 20, "the least of the public configurations, 0.5 to 3",
               "Points that are not farther from the sensor are left out and stay."})
      .number("max_range", &P::max_range,
              {"m", 1, 300, "the public configurations",
               "Voxels farther from the sensor are neither observed nor judged."});
}

void add_state(Table& table) {
  table
      .number("spread", &P::spread,
              {"voxels", 0.25, 1.5, "'sigma', a voxel's edge in the public configurations",
               "Standard deviation of the distance to the nearest occupied voxel, of this scan or "
               "the one before, at which a voxel counts as occupied."})
      .number("transition", &P::transition,
              {"", 0.001, 0.1, "epsilon, constant of the public program",
               "Probability of each change of state between two scans."})
      .number("belief", &P::belief,
              {"", 0.5, 0.9999, "the public configurations",
               "A voxel takes a state whose probability is above this."})
      .integer("map_scans", &P::map_scans,
               {"scans", 1, 100000, "w_G, the public configurations",
                "A voxel that was not seen for more scans is forgotten."})
      .number("map_range_factor", &P::map_range_factor,
              {"", 1, 10, "constant of the public program",
               "Voxels farther from the sensor than max_range times this are forgotten."});
}

void add_change(Table& table) {
  table
      .integer("reach", &P::reach,
               {"voxels", 1, 4, "a convolution of 5 voxels in the public configurations",
                "Half side of the cube around a voxel in which changes are counted."})
      .integer("window_scans", &P::window_scans,
               {"scans", 1, 100, "w_L, the public configurations (3 for HeLiMOS)",
                "Scores of so many scans are added up; one more scan is let pass before the first "
                "score."})
      .integer("bins", &P::bins,
               {"", 2, 10000, "constant of the public program",
                "Bins of the histogram of scores in which Otsu's threshold is found."})
      .number(
          "least_threshold", &P::least_threshold,
          {"", 0, 10000, "'minOtsu' of the public configurations",
           "A scan whose threshold is not above this is static as a whole, and a voxel that was "
           "dynamic in the scan before stays so if its score is above this."});
}

Table make_table() {
  Table table;
  add_scan(table);
  add_state(table);
  add_change(table);
  table
      .flag("public_lattice", &P::public_lattice,
            {.source = "the public program",
             .sentence = "Indices of voxels are cut off towards zero, so that those around the "
                         "origin are twice as wide, and a voxel lies at its corner; the sensor's "
                         "voxel is rounded down all the same. Else all are rounded down, and a "
                         "voxel lies at its middle."})
      .flag(
          "offline", &P::offline,
          {.source = "ours",
           .sentence = "Answer after the last scan: points whose voxel was free when its state was "
                       "last known go as well."});
  return table;
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace raymoval::hmm_mos_method
