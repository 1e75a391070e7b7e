// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/hmm_mos.h"

namespace raymoval {
namespace hmm_mos_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

void add_map(Table& table) {
  table
      .number("voxel_size", &P::voxel_size,
              {"m", 0.05, 2, "all configurations of the public program (its README says 0.2)",
               "Edge of a voxel."})
      .number("min_range", &P::min_range,
              {"m", 0, 20, "the least of the public configurations, 0.5 to 3",
               "Points up to this range are left out and kept."})
      .number("max_range", &P::max_range,
              {"m", 1, 300, "the public configurations",
               "Voxels farther from the sensor are neither observed nor judged."})
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
                "A voxel without observation for more scans is deleted."})
      .number("map_range_factor", &P::map_range_factor,
              {"", 1, 10, "constant of the public program",
               "Voxels farther from the sensor than max_range times this are deleted."});
}

Table make_table() {
  Table table;
  add_map(table);
  table
      .integer("reach", &P::reach,
               {"voxels", 1, 4, "a convolution of 5 voxels in the public configurations",
                "Half side of the cube around a voxel in which changes are counted."})
      .integer("window_scans", &P::window_scans,
               {"scans", 1, 100, "w_L, the public configurations (3 for HeLiMOS)",
                "Number of scans whose scores are summed; the first score comes one scan later."})
      .number(
          "least_threshold", &P::least_threshold,
          {"", 0, 10000, "'minOtsu' of the public configurations",
           "A scan whose threshold is not above this is static as a whole, and a voxel that was "
           "dynamic in the scan before stays so if its score is above this."})
      .flag("public_lattice", &P::public_lattice,
            {.source = "the public program",
             .sentence = "Voxel indices are truncated towards zero, so that voxels around the "
                         "origin are twice as wide, and the position of a voxel is its corner; the "
                         "sensor's voxel is rounded down. Else all are rounded down, and the "
                         "position of a voxel is its centre."})
      .flag("offline", &P::offline,
            {.source = "ours",
             .sentence = "Answer after the last scan: also remove points whose voxel was free when "
                         "its state was last known."});
  return table;
}

}  // namespace
}  // namespace hmm_mos_method

MethodEntry hmm_mos_entry() {
  MethodEntry entry;
  entry.name = "hmm_mos";
  entry.version = "2";
  entry.sentence =
      "A hidden Markov model estimates whether each voxel is free or occupied; points in voxels "
      "that were free just before are moving.";
  entry.source =
      "Moving Object Segmentation in Point Cloud Data using Hidden Markov Models (IROS 2024 "
      "workshop)";
  entry.bibtex = R"(@misc{bhandari2024hmmmos,
  author = {Bhandari, Vedant and James, Jasmin and Phillips, Tyson and McAree, P. Ross},
  title = {Moving Object Segmentation in Point Cloud Data using Hidden Markov Models},
  year = {2024},
  eprint = {2410.18638},
  archiveprefix = {arXiv}
}
)";
  entry.notes = {
      // The page of the method has all notes.
      "The default is the public program with its lattice; offline is without it.",
      "Nothing depends on the sensor but its range. Of the public configurations' least ranges "
      "the smallest is the default, which leaves out the fewest points.",
      "Hits beyond max_range count for distances, as in the public program: distances are to all "
      "hits of this scan and the one before.",
      "Where all scores are equal there is no threshold and nothing moves; voxels of the scan "
      "before may still stay dynamic for the next.",
      "offline is ours: it removes points that moved when they were measured, and points whose "
      "voxel was free when its state was last known. The public program has no answer for a whole "
      "map.",
  };
  entry.variants = {
      {.name = "published", .sentence = "As the public program is set.", .online = true},
      {.name = "fine",
       .sentence = "With voxels of 0.2 m, as its README says.",
       .online = true,
       .overrides = {{"voxel_size", 0.2}}},
      {.name = "offline",
       .sentence = "Ours: voxel positions are centres, and points whose voxel was last known to be "
                   "free are removed.",
       .overrides = {{"public_lattice", false}, {"offline", true}},
       .developed_on = "KITTI raw drive 0005"},
  };
  entry.bind(hmm_mos_method::make_table(), hmm_mos_method::make_hmm_mos);
  return entry;
}

}  // namespace raymoval
