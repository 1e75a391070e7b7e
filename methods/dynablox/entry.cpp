// SPDX-License-Identifier: MIT
#include "methods/dynablox/dynablox.h"

namespace raymoval {
namespace dynablox_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

const char* const kShipped = "the public program's configuration";
const char* const kOnline = "offline is false";

Table make_table() {
  return Table()
      .number("voxel_size", &P::voxel_size, {"m", 0.1, 2, kShipped, "Edge of a voxel."})
      .number("min_range", &P::min_range,
              {"m", 0, 50, kShipped, "Nearer returns and voxels give no evidence of free space."})
      .number("max_range", &P::max_range,
              {"m", 1, 150, kShipped,
               "Farther voxels are not updated, nor those beyond the sensor's own range. It must "
               "be more than min_range."})
      .number("truncation", &P::truncation,
              {"m", 0.05, 10, kShipped,
               "Distances to surfaces are truncated here; voxels further behind a surface are not "
               "updated. It must be more than occupied_below."})
      .integer("max_weight", &P::max_weight,
               {"", 1, 65535, kShipped,
                "A voxel's distance is the weighted mean over its scans; the earlier scans "
                "together weigh at most this."})
      .number("occupied_below", &P::occupied_below,
              {"m", 0.01, 10, "'tsdf_occupancy_threshold'",
               "A voxel nearer to a surface than this is occupied, as is a voxel with points. It "
               "must be less than truncation."})
      .integer("temporal_buffer", &P::temporal_buffer,
               {"scans", 0, 1000, kShipped,
                "A voxel that was free for at most this many scans still counts as occupied."})
      .integer(
          "burn_in", &P::burn_in,
          {"scans", 1, 1000, "'burn_in_period'",
           "A voxel becomes ever-free if it and its neighbours were free for this many scans."})
      .integer("frames_to_reset", &P::frames_to_reset,
               {"scans", 1, 65535, "'counter_to_reset'",
                "A voxel that was occupied for this many scans is no longer ever-free, nor are its "
                "neighbours."})
      .number(
          "separation", &P::separation,
          {"m", 0, 1, "'min_cluster_separation'",
           "Clusters are merged if centres of their voxels are at most this far apart.", kOnline})
      .integer("min_points", &P::min_points,
               {"points", 1, 1000000, kShipped, "Smaller clusters are discarded.", kOnline})
      .flag("offline", &P::offline,
            {.source = "not in the paper",
             .sentence = "Remove every point in a voxel that is ever-free after the last scan. "
                         "Else remove the points of each scan's clusters when it arrives."});
}

}  // namespace
}  // namespace dynablox_method

MethodEntry dynablox_entry() {
  MethodEntry entry;
  entry.name = "dynablox";
  entry.version = "2";
  entry.sentence =
      "Finds voxels that were certainly free at some time by a distance field; points that appear "
      "in them are moving.";
  entry.source = "Dynablox: Real-time Detection of Diverse Dynamic Objects (RA-L 2023)";
  entry.bibtex = R"(@article{schmid2023dynablox,
  author = {Schmid, Lukas and Andersson, Olov and Sulser, Aurelio and Pfreundschuh, Patrick and
    Siegwart, Roland},
  title = {Dynablox: Real-time Detection of Diverse Dynamic Objects in Complex Environments},
  journal = {IEEE Robotics and Automation Letters},
  year = {2023},
  volume = {8},
  number = {10},
  pages = {6259--6266},
  doi = {10.1109/LRA.2023.3305239}
}
)";
  entry.notes = {
      "The default is as published and without the public program's mistakes (when it compares "
      "boxes of clusters, merges clusters, and resets voxels), which change hardly any score.",
      "Rows, columns and the vertical field of view of the range image are the sensor's.",
      "A pixel has its nearest return, but for those nearer than min_range, which are left out.",
      "Voxels are reset all at once, so that no order of voxels or blocks counts; in the public "
      "program a voxel that another one has just reset resets no more.",
      "A voxel with points that touches two clusters makes them one, so that no order of seeds "
      "counts; centres of voxels, not points, are compared when clusters are merged, as the "
      "shipped configuration does.",
      "Largest sizes of clusters, and tracks of clusters, which the shipped configuration leaves "
      "off, are left out, as is the voxels' flag 'dynamic', which nothing reads.",
  };
  entry.variants = {
      {.name = "published",
       .sentence = "As the public program is configured, without its mistakes.",
       .online = true},
      {.name = "wide",
       .sentence = "Up to 80 m instead of 20.",
       .online = true,
       .overrides = {{"max_range", 80.0}}},
      {.name = "offline",
       .sentence = "Removes points whose voxel is ever-free after the last scan.",
       .overrides = {{"offline", true}}},
      {.name = "offline-wide",
       .sentence = "Both.",
       .overrides = {{"max_range", 80.0}, {"offline", true}},
       .developed_on = "KITTI raw drive 0005"},
  };
  entry.bind(dynablox_method::make_table(), dynablox_method::make_dynablox);
  return entry;
}

}  // namespace raymoval
