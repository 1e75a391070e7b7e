// SPDX-License-Identifier: MIT
#include "methods/dynablox/parameters.h"

namespace raymoval::dynablox_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

const char* const kShipped = "the public program's configuration";
const char* const kProgram = "the public program";
const char* const kOurs = "not in the paper";
const char* const kOnline = "offline is false";

void add_field(Table& table) {
  table.number("voxel_size", &P::voxel_size, {"m", 0.1, 2, kShipped, "Edge of a voxel."})
      .number("min_range", &P::min_range,
              {"m", 0, 50, kShipped, "Nearer returns and voxels tell nothing of free space."})
      .number("max_range", &P::max_range,
              {"m", 1, 150, kShipped,
               "Voxels beyond are not updated, nor beyond the sensor's own range. It must be more "
               "than min_range."})
      .number("truncation", &P::truncation,
              {"m", 0.05, 10, kShipped,
               "Distances to surfaces are cut off here; voxels that lie further behind one are "
               "not updated. It must be more than occupied_below."})
      .choice(
          "weights", &P::weights, {{"rays", Weights::kRays}, {"constant", Weights::kConstant}},
          {.source = kProgram,
           .sentence =
               "What a scan weighs in a voxel's distance: as many rays as go through the voxel, "
               "and less the more than a voxel it lies behind the surface; or 1."})
      .integer("max_weight", &P::max_weight,
               {"", 1, 65535, kShipped,
                "A voxel's distance is the mean over its scans, of which the earlier ones weigh no "
                "more than this together."})
      .choice("clearing", &P::clearing,
              {{"nothing", FarReturns::kNothing},
               {"image", FarReturns::kImage},
               {"blocks", FarReturns::kBlocks}},
              {.source = kProgram,
               .sentence = "What a return from beyond max_range says: nothing; that the way up to "
                           "there is free, in blocks to which nearer returns lead; or that it is, "
                           "in all blocks on the way."});
}

void add_image(Table& table) {
  table
      .choice("interpolation", &P::interpolation,
              {{"adaptive", Interpolation::kAdaptive}, {"mean", Interpolation::kMean}},
              {.source = kProgram,
               .sentence = "The range between four pixels: their mean, but the nearest one if that "
                           "is nearer than the mean by more than half the truncation; or the mean "
                           "of those with a return."})
      .choice(
          "image", &P::image, {{"sensor", ImageSource::kSensor}, {"fixed", ImageSource::kFixed}},
          {.source = kOurs,
           .sentence = "Whether the range image is as large as the sensor's model says (what it "
                       "does not know is as published), or as the next three parameters."})
      .integer("image_columns", &P::image_columns,
               {"pixels", 8, 16384, kShipped, "Of a full circle.", "image is fixed"})
      .integer("image_rows", &P::image_rows,
               {"pixels", 2, 1024, kShipped, "Of the vertical field of view.", "image is fixed"})
      .number("vertical_view", &P::vertical_view,
              {"deg", 1, 180, kShipped, "Vertical field of view, half of it below the horizon.",
               "image is fixed"});
}

void add_free_space(Table& table) {
  const std::vector<std::pair<std::string, Neighbours>> neighbours = {
      {"faces", Neighbours::kFaces},
      {"edges", Neighbours::kEdges},
      {"corners", Neighbours::kCorners}};
  table
      .choice(
          "judged", &P::judged, {{"all", Judged::kAll}, {"within", Judged::kWithin}},
          {.source = kProgram,
           .sentence = "Which points make voxels occupied and may be in clusters: all, or those "
                       "from min_range to max_range."})
      .choice(
          "new_voxels", &P::new_voxels,
          {{"free", NewVoxels::kFree}, {"occupied", NewVoxels::kOccupied}},
          {.source = kProgram,
           .sentence = "What voxels were before the scan that makes their block: never occupied, "
                       "or occupied in that scan."})
      .number("occupied_below", &P::occupied_below,
              {"m", 0.01, 10, "'tsdf_occupancy_threshold'",
               "A voxel that is nearer to a surface is occupied, as is one with points. It must be "
               "less than truncation."})
      .integer("temporal_buffer", &P::temporal_buffer,
               {"scans", 0, 1000, kShipped,
                "A voxel that was free for no longer counts as occupied all the while."})
      .integer("burn_in", &P::burn_in,
               {"scans", 1, 1000, "'burn_in_period'",
                "A voxel that was free for so long, and its neighbours with it, is ever free."})
      .integer("frames_to_reset", &P::frames_to_reset,
               {"scans", 1, 65535, "'counter_to_reset'",
                "A voxel that was occupied for so long is no longer ever free, nor are its "
                "neighbours."})
      .choice("free_neighbours", &P::free_neighbours, neighbours,
              {.source = "'neighbor_connectivity', 26 in the public program's configuration",
               .sentence = "Which neighbours become ever free together, or cease to be: 6, 18 or "
                           "26."})
      .choice("cluster_neighbours", &P::cluster_neighbours, neighbours,
              {.source = "'neighbor_connectivity', 6 in the public program's configuration",
               .sentence = "Which neighbours a cluster grows to: 6, 18 or 26.",
               .acts_when = kOnline});
}

void add_clusters(Table& table) {
  table
      .flag("grow_twice", &P::grow_twice,
            {.source = "'grow_clusters_twice'",
             .sentence = "A cluster takes in the voxels with points beside those that are ever "
                         "free, and those beside these. Else the first only.",
             .acts_when = kOnline})
      .number("separation", &P::separation,
              {"m", 0, 1, "'min_cluster_separation'",
               "Clusters are one if centres of their voxels are no further apart.", kOnline})
      .integer("min_points", &P::min_points,
               {"points", 1, 1000000, kShipped, "A smaller cluster is none.", kOnline})
      .integer("max_points", &P::max_points,
               {"points", 1, 10000000, kShipped, "A larger cluster is none.", kOnline})
      .choice("extents", &P::extents, {{"voxels", Extents::kVoxels}, {"points", Extents::kPoints}},
              {.source = "'check_cluster_separation_exact'",
               .sentence = "What the box of a cluster is around: its voxels or its points.",
               .acts_when = kOnline})
      .number(
          "min_extent", &P::min_extent,
          {"m", 0, 1000, kShipped, "A cluster whose box has a shorter diagonal is none.", kOnline})
      .number("max_extent", &P::max_extent,
              {"m", 0, 1000000, kShipped, "A cluster whose box has a longer diagonal is none.",
               kOnline})
      .integer("min_track", &P::min_track,
               {"scans", 0, 1000, "'min_track_duration'",
                "A cluster that was followed through fewer earlier scans stays.", kOnline})
      .number("track_distance", &P::track_distance,
              {"m", 0, 100, "'max_tracking_distance'",
               "A cluster's mean moves no further from scan to scan.",
               "offline is false and min_track > 0"});
}

void add_answer(Table& table) {
  table
      .flag("offline", &P::offline,
            {.source = kOurs,
             .sentence = "Every point goes that lies in a voxel which is ever free in the end. "
                         "Else the points of a scan's clusters, judged when it comes."})
      .flag("public_boxes", &P::public_boxes,
            {.source = kProgram,
             .sentence = "Clusters are one only if the lower end of the first one's box is not "
                         "above the other's furthest x, which the public program takes for its "
                         "upper end.",
             .acts_when = kOnline})
      .flag("public_merges", &P::public_merges,
            {.source = kProgram,
             .sentence = "A cluster that took in another one is compared with further ones "
                         "by its own voxels only, which its box is around.",
             .acts_when = kOnline})
      .flag("public_unmapped", &P::public_unmapped,
            {.source = kProgram,
             .sentence = "Points outside the blocks of the map so far are in no cluster.",
             .acts_when = kOnline})
      .flag("public_reset", &P::public_reset,
            {.source = kProgram,
             .sentence = "A voxel that was once occupied for frames_to_reset is reset in each scan "
                         "whose rays touch its block, even where it is free by now."});
}

Table make_table() {
  Table table;
  add_field(table);
  add_image(table);
  add_free_space(table);
  add_clusters(table);
  add_answer(table);
  return table;
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace raymoval::dynablox_method
