// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/parameters.h"

#include "methods/raymoval_plus/raymoval_plus.h"

namespace raymoval {
namespace {

using Table = ParameterTable<RaymovalPlusParameters>;
using P = RaymovalPlusParameters;
constexpr const char* kSource = "this project";
// When parameters act.
constexpr const char* kObjects = "objects is true";
constexpr const char* kTracks = "objects is true and tracks is true";

void add_terrain(Table& table) {
  table
      .flag("terrain", &P::terrain,
            {.source = kSource, .sentence = "Find the ground and keep its points."})
      .number("terrain_cell", &P::terrain_cell,
              {"m", 0.1, 5, kSource, "Edge of a ground column.", "terrain is true"})
      .number("terrain_quantile", &P::terrain_quantile,
              {"", 0, 0.5, kSource, "Quantile of a column's heights taken for its ground.",
               "terrain is true"})
      .number("terrain_drop", &P::terrain_drop,
              {"m", 0, 10, kSource, "A column this much below its neighbours' quartile is dropped.",
               "terrain is true"})
      .number("terrain_slope", &P::terrain_slope,
              {"", 0, 2, kSource, "Steepest ground from a column to its neighbours.",
               "terrain is true"})
      .number("terrain_reach", &P::terrain_reach,
              {"m", 0, 10, kSource, "How far a column's ground bounds that of its neighbours.",
               "terrain is true"})
      .number("ground_height", &P::ground_height,
              {"m", 0, 1, kSource, "Points lower than this above the ground are ground.",
               "terrain is true"});
}

void add_when(Table& table) {
  table
      .flag("at_once", &P::at_once,
            {.source = kSource,
             .sentence = "Answer each scan when it comes, from it and the scans before."})
      .flag("one_pass", &P::one_pass,
            {.source = kSource,
             .sentence = "Gather the evidence as scans come, in one pass; answer at the end.",
             .acts_when = "at_once is false"})
      .integer("history_scans", &P::history_scans,
               {"scans", 0, 1000, kSource,
                "Earlier scans kept to ask about new voxels (at_once, one_pass).",
                "at_once is true or one_pass is true"})
      .integer("history_step", &P::history_step,
               {"scans", 1, 1000, kSource, "Of so many scans one is kept.",
                "at_once is true and history_scans > 0 or one_pass is true and history_scans > 0"})
      .integer("terrain_period", &P::terrain_period,
               {"scans", 1, 1000, kSource, "The ground is found anew every so many scans.",
                "terrain is true and at_once is true or terrain is true and one_pass is true"});
}

void add_evidence(Table& table) {
  table.number("voxel_size", &P::voxel_size, {"m", 0.02, 2, kSource, "Edge of a voxel."})
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 20, kSource, "Nearer returns are the vehicle itself."})
      .number("evidence_range_min", &P::evidence_range_min,
              {"m", 0, 50, kSource, "Nearer voxels are not tested."})
      .number("evidence_range_max", &P::evidence_range_max,
              {"m", 1, 500, kSource, "Farther voxels are not tested."})
      .number("azimuth_bin", &P::azimuth_bin,
              {"deg", 0, 5, kSource, "Width of a range image bin; 0 takes 1.45 beams."})
      .number("elevation_bin", &P::elevation_bin,
              {"deg", 0, 5, kSource, "Height of a range image bin; 0 takes half a beam."})
      .integer("window_columns", &P::window_columns,
               {"bins", 0, 30, kSource, "Least half width of the window around a voxel."})
      .integer("window_rows", &P::window_rows,
               {"bins", 0, 60, kSource, "Least half height of the window around a voxel."})
      .number("agree_constant", &P::agree_constant,
              {"m", 0, 5, kSource, "A return this near to the voxel's range agrees with it."})
      .number("agree_slope", &P::agree_slope,
              {"", 0, 1, kSource, "Part of it that grows with range."})
      .number("occluded_constant", &P::occluded_constant,
              {"m", 0, 5, kSource, "A return nearer than the voxel's range plus this occludes it."})
      .number("occluded_slope", &P::occluded_slope,
              {"", 0, 1, kSource, "Part of it that grows with range."})
      .number(
          "free_constant", &P::free_constant,
          {"scans", 0, 1000, kSource, "Scans that must see through a voxel to make it dynamic."})
      .number("free_per_agree", &P::free_per_agree,
              {"", 0, 10, kSource, "And this many more for each scan that agrees with it."})
      .integer("static_agree", &P::static_agree,
               {"scans", 1, 1000, kSource, "Scans that must agree to make a voxel static."});
}

void add_groups(Table& table) {
  table
      .integer(
          "vote_radius", &P::vote_radius,
          {"voxels", 0, 8, kSource, "Half width of the cube of voxels that vote; 0 for no vote."})
      .number("vote_share", &P::vote_share,
              {"", 0, 1, kSource, "Share of dynamic voxels that makes a voxel dynamic."})
      .number("vote_keep", &P::vote_keep,
              {"", 0, 1, kSource, "Share of dynamic voxels below which a dynamic voxel is not."})
      .integer("run_scans", &P::run_scans,
               {"scans", 0, 1000, kSource,
                "Scans in a row that see through a voxel at one end of its story make it dynamic; "
                "0 for off."})
      .number("run_range", &P::run_range,
              {"m", 0, 500, kSource, "Range up to which those count.", "run_scans > 0"})
      .flag("objects", &P::objects,
            {.source = kSource, .sentence = "Judge clusters of a scan as one."})
      .number("object_height", &P::object_height,
              {"m", 0, 5, kSource, "Clusters consist of points at least this high.",
               "terrain is true and objects is true or terrain is true and low_points is true"})
      .number("cluster_gap", &P::cluster_gap,
              {"m", 0.05, 5, kSource, "Points this near to each other are one cluster.", kObjects})
      .number("cluster_growth", &P::cluster_growth,
              {"", 0, 1, kSource, "Part of it that grows with range.", kObjects})
      .number(
          "object_dynamic_share", &P::object_dynamic_share,
          {"", 0, 1, kSource, "Share of dynamic points that makes a cluster dynamic.", kObjects})
      .number(
          "object_static_share", &P::object_static_share,
          {"", 0, 1, kSource, "Share of dynamic points up to which a cluster is static.", kObjects})
      .integer("object_points", &P::object_points,
               {"points", 1, 1000, kSource, "Smallest cluster judged dynamic as one.", kObjects})
      .integer(
          "group_points", &P::group_points,
          {"points", 1, 1000000, kSource,
           "A group of dynamic points this large stays dynamic in a static cluster.", kObjects})
      .integer("settled_scans", &P::settled_scans,
               {"scans", 0, 10000, kSource,
                "With so many scans that agree and none that saw through, a voxel is not outvoted; "
                "points of voxels with so many are left out when a mixed cluster is divided; 0 for "
                "neither."})
      .flag("tracks", &P::tracks,
            {.source = kSource,
             .sentence = "Follow dynamic clusters over scans.",
             .acts_when = "objects is true"})
      .number("track_dynamic_share", &P::track_dynamic_share,
              {"", 0, 1, kSource, "Share of a track's clusters that must be dynamic.", kTracks})
      .number("track_slack", &P::track_slack,
              {"", 0, 10, kSource,
               "How much longer than its length explains scans may agree on an object.", kTracks})
      .number("track_width", &P::track_width,
              {"m", 0, 100, kSource, "Wider clusters are not followed.", kTracks})
      .integer("track_points", &P::track_points,
               {"points", 1, 1000, kSource, "Smaller clusters are not followed.", kTracks})
      .flag("low_points", &P::low_points,
            {.source = kSource,
             .sentence = "Points near the ground follow what stands above them.",
             .acts_when = "terrain is true"});
}

}  // namespace

const ParameterTable<RaymovalPlusParameters>& raymoval_plus_parameters() {
  static const Table table = [] {
    Table made;
    add_when(made);
    add_terrain(made);
    add_evidence(made);
    add_groups(made);
    return made;
  }();
  return table;
}

MethodEntry raymoval_plus_entry() {
  MethodEntry entry;
  entry.name = "raymoval_plus";
  entry.sentence =
      "Terrain, three-way evidence of every scan on every voxel, a vote, objects and tracks.";
  entry.source = "this project";
  entry.version = "4";
  entry.parameters = raymoval_plus_parameters().specs();
  entry.variants = {
      {"offline", "Every point answered from all scans.", false, {}},
      {"online", "Each scan answered when it comes.", true, {{"at_once", true}}},
      {"online-map",
       "One pass as the scans come, every point answered by the map as it is in the end.",
       false,
       {{"one_pass", true}}},
  };
  entry.make = [](const Configuration& configuration) {
    return make_raymoval_plus(raymoval_plus_parameters().read(configuration));
  };
  return entry;
}

}  // namespace raymoval
