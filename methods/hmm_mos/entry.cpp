// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/hmm_mos.h"

namespace raymoval {

MethodEntry hmm_mos_entry() {
  const Configuration sound = {{"public_lattice", false}};
  Configuration offline = sound;
  offline.emplace_back("offline", true);
  MethodEntry entry;
  entry.name = "hmm_mos";
  entry.version = "2";
  entry.sentence =
      "A hidden Markov model of each voxel, free or occupied: what is occupied where it was free "
      "just before moves.";
  entry.source =
      "Moving Object Segmentation in Point Cloud Data using Hidden Markov Models (IROS 2024 "
      "workshop)";
  entry.notes = {
      "The default is the public program with its lattice, which has a switch (public_lattice).",
      "Nothing depends on the sensor but its range. Of the public configurations' least ranges the "
      "smallest is the default, which leaves out the fewest points.",
      "Ranges are measured from the sensor's position to where a voxel lies.",
      "What is hit beyond max_range is near to what is within, as in the public program: distances "
      "are those to all hits of this scan and the one before.",
      "The first scan has no scan before it; what is nearest is looked for in it alone.",
      "From a distance on (9.8 voxels by default) all distances are alike: in double precision the "
      "next step of a voxel's belief comes out the same.",
      "A voxel that was forgotten begins anew; the scores of the window stay.",
      "Edges of the histogram's bins are compared in whole numbers, so that no score falls into "
      "another bin by rounding.",
      "Where all scores are equal there is no threshold and nothing moves; voxels of the scan "
      "before may still stay dynamic for the next.",
      "offline is ours: what moved when it was seen goes, and points whose voxel was free when its "
      "state was last known. The public program has no answer for a whole map.",
  };
  entry.variants = {
      {"published", "As the public program is set.", true, {}},
      {"fine", "With voxels of 0.2 m, as its README says.", true, {{"voxel_size", 0.2}}},
      {"sound", "Without the quirk of the public program.", true, sound},
      {"offline", "Ours: sound, and points go whose voxel was last known to be free.", false,
       offline},
  };
  entry.bind(hmm_mos_method::parameter_table(), hmm_mos_method::make_hmm_mos);
  return entry;
}

}  // namespace raymoval
