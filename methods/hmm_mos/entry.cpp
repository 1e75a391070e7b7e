// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/hmm_mos.h"

namespace raymoval {

MethodEntry hmm_mos_entry() {
  MethodEntry entry;
  entry.name = "hmm_mos";
  entry.sentence =
      "A hidden Markov model of each voxel, free or occupied: what becomes occupied in a place "
      "that "
      "was free moves.";
  entry.source =
      "Moving Object Segmentation in Point Cloud Data using Hidden Markov Models (IROS 2024 "
      "workshop)";
  entry.notes = {};
  entry.variants = {
      {"published", "As the public program is set.", true, {}},
      {"fine", "With voxels of 0.2 m, as its README says.", true, {{"voxel_size", 0.2}}},
      {"sound", "Without the quirks of the public program.", true, {{"public_lattice", false}}},
      {"offline",
       "By the last state of each voxel.",
       false,
       {{"public_lattice", false}, {"offline", true}}},
  };
  entry.bind(hmm_mos_method::parameter_table(), hmm_mos_method::make_hmm_mos);
  return entry;
}

}  // namespace raymoval
