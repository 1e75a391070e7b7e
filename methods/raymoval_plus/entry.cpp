// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

namespace raymoval {

MethodEntry raymoval_plus_entry() {
  MethodEntry entry;
  entry.name = "raymoval_plus";
  entry.sentence =
      "Terrain, three-way evidence of every scan on every voxel, a vote, objects and tracks.";
  entry.source = "this project";
  entry.version = "30";
  entry.confidence = {
      "What was decided on a point, the evidence of its voxel, and the dynamic share of its "
      "object.",
      // Fitted to ten simulated worlds, odd seeds, five sensors (EXPERIMENTS.md, "Confidence").
      {{0.0000F, 0.0040F},
       {0.0247F, 0.0182F},
       {0.0680F, 0.0331F},
       {0.1293F, 0.0577F},
       {0.2350F, 0.1453F},
       {0.5012F, 0.2776F},
       {0.5570F, 0.6291F},
       {0.6309F, 0.7492F},
       {0.7442F, 0.8793F},
       {0.8769F, 0.9403F},
       {0.9203F, 0.9645F},
       {0.9458F, 0.9839F},
       {0.9694F, 0.9940F},
       {0.9844F, 0.9989F}}};
  // EXPERIMENTS.md, "Main parameters", has what each changes.
  entry.main_parameters = {"voxel_contradiction", "object_passes", "vote_share",
                           "evidence_range_max", "voxel_size"};
  entry.advice =
      "If too much is removed, raise voxel_contradiction, object_passes or vote_share. If too "
      "little "
      "is removed, lower them; if far objects stay, raise evidence_range_max.";
  // Who answers soon has not seen yet what comes after: more scans from before are kept, and fewer
  // voxels around have to be dynamic.
  const Configuration at_once = {{"at_once", true}, {"history_scans", 40}, {"vote_share", 0.4}};
  Configuration a_second_later = at_once;
  a_second_later.emplace_back("delay", 1.0);
  entry.variants = {
      {.name = "offline", .sentence = "Every point answered from all scans."},
      {.name = "online",
       .sentence = "Each scan answered when it comes.",
       .online = true,
       .overrides = at_once},
      {.name = "online-lag",
       .sentence =
           "Each scan answered once, a second after it came (delay), from the scans up to then.",
       .online = true,
       .overrides = a_second_later},
      {.name = "online-map",
       .sentence =
           "One pass as the scans come, every point answered by the map as it is in the end.",
       .overrides = {{"one_pass", true}}},
  };
  entry.bind(raymoval_plus_method::parameter_table(), raymoval_plus_method::make_raymoval_plus);
  return entry;
}

}  // namespace raymoval
