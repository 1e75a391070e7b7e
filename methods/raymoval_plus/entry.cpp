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
      // Shares of moving points in ten bins of evidence, over nine simulated sequences and KITTI
      // raw drive 0005 (README.md, "Confidence").
      {{0.002F, 0.001F},
       {0.13F, 0.01F},
       {0.23F, 0.02F},
       {0.33F, 0.03F},
       {0.42F, 0.10F},
       {0.50F, 0.15F},
       {0.63F, 0.40F},
       {0.74F, 0.87F},
       {0.84F, 0.97F},
       {0.94F, 0.998F}}};
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
  for (MethodVariant& variant : entry.variants) {
    variant.developed_on = "KITTI raw drive 0005 and simulated scenes with development seeds";
  }
  entry.bind(raymoval_plus_method::parameter_table(), raymoval_plus_method::make_raymoval_plus);
  return entry;
}

}  // namespace raymoval
