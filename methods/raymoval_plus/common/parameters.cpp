// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/parameters.h"

namespace raymoval::raymoval_plus_method {
namespace {

using P = Parameters;
constexpr const char* kSource = "this project";
// When parameters act.
constexpr const char* kTerrain = "terrain is true";
constexpr const char* kObjects = "objects is true";
constexpr const char* kTracks = "objects is true and tracks is true";
constexpr const char* kGaps = "objects is true or terrain is true and low_points is true";
// The least value of what must be more than 0. With 0, voxels would be dynamic that no scan saw
// through (free_constant), or that have no dynamic one around them (vote_share).
constexpr double kMoreThanNone = 0.001;

/// The table, line by line.
struct Lines {
  void number(const char* name, double P::*member, const char* unit, double minimum, double maximum,
              const char* sentence, const char* acts_when = "") {
    table.number(name, member, {unit, minimum, maximum, kSource, sentence, acts_when});
  }
  void integer(const char* name, int P::*member, const char* unit, double minimum, double maximum,
               const char* sentence, const char* acts_when = "") {
    table.integer(name, member, {unit, minimum, maximum, kSource, sentence, acts_when});
  }
  void flag(const char* name, bool P::*member, const char* sentence, const char* acts_when = "") {
    table.flag(name, member, {.source = kSource, .sentence = sentence, .acts_when = acts_when});
  }
  ParameterTable<P> table;
};

void add_when(Lines& table) {
  table.flag("at_once", &P::at_once,
             "Answer each scan when it comes, or a fixed time after it, and never again.");
  table.flag("one_pass", &P::one_pass,
             "Gather the evidence as scans come, in one pass; answer at the end.",
             "at_once is false");
  table.number("delay", &P::delay, "s", 0, 10,
               "Each scan is answered so long after it, from the scans that came by then.",
               "at_once is true");
  table.integer("recent_scans", &P::recent_scans, "scans", 0, 1000,
                "Objects of this many scans before are judged again, to find tracks.",
                "at_once is true and objects is true and tracks is true");
  table.integer("history_scans", &P::history_scans, "scans", 0, 1000,
                "This many earlier scans are kept to ask them about new voxels.",
                "at_once is true or one_pass is true");
  table.integer("history_step", &P::history_step, "scans", 1, 1000, "One of so many scans is kept.",
                "at_once is true and history_scans > 0 or one_pass is true and history_scans > 0");
  table.integer("terrain_period", &P::terrain_period, "scans", 1, 1000,
                "The ground is found anew every so many scans.",
                "terrain is true and at_once is true or terrain is true and one_pass is true");
}

void add_terrain(Lines& table) {
  table.flag("terrain", &P::terrain, "Find the ground and keep its points.");
  table.number("terrain_cell", &P::terrain_cell, "m", 0.1, 5, "Edge of a ground column.", kTerrain);
  table.number("terrain_quantile", &P::terrain_quantile, "", 0, 0.5,
               "Quantile of a column's heights that is taken for its ground.", kTerrain);
  table.number("terrain_drop", &P::terrain_drop, "m", 0, 10,
               "A column this much below its neighbours' quartile is dropped.", kTerrain);
  table.number("terrain_slope", &P::terrain_slope, "", 0, 2,
               "Steepest ground from a column to its neighbours, beside the rise of steep land.",
               kTerrain);
  table.number("terrain_reach", &P::terrain_reach, "m", 0, 10,
               "How far a column's ground bounds that of its neighbours.", kTerrain);
  table.number("terrain_far_slope", &P::terrain_far_slope, "", 0, 2,
               "Steepest ground over up to 22 columns, beside the slope of the land around; 0 for "
               "any.",
               kTerrain);
  table.number("ground_height", &P::ground_height, "m", 0, 1,
               "Points lower than this above the ground are ground.", kTerrain);
}

void add_evidence(Lines& table) {
  table.number("voxel_size", &P::voxel_size, "m", 0.02, 2, "Edge of a voxel.");
  table.number(
      "minimum_range", &P::minimum_range, "m", 0, 20,
      "Nearer returns are the vehicle itself: no range image has them. Terrain, voxels and "
      "clusters do.");
  table.number("evidence_range_min", &P::evidence_range_min, "m", 0, 50,
               "Nearer voxels are not tested.");
  table.number("evidence_range_max", &P::evidence_range_max, "m", 1, 500,
               "Farther voxels are not tested, and farther points are in no cluster and are no "
               "lone drops.");
  table.number("azimuth_bin", &P::azimuth_bin, "deg", 0, 5,
               "Width of a bin of the range image; 0 takes 1.45 beams.");
  table.number("elevation_bin", &P::elevation_bin, "deg", 0, 5,
               "Height of a bin of the range image; 0 takes half a beam.");
  table.integer("window_columns", &P::window_columns, "bins", 0, 30,
                "Least half width of the window around a voxel.");
  table.integer("window_rows", &P::window_rows, "bins", 0, 60,
                "Least half height of the window around a voxel.");
  table.number(
      "agree_constant", &P::agree_constant, "m", 0, 5,
      "A return this near to the voxel's range agrees with it. Tracks therefore allow scans "
      "to agree with what passes as if it were longer by twice this.");
  table.number("agree_slope", &P::agree_slope, "", 0, 1,
               "agree_constant grows by this much with each metre of range.");
  table.number("occluded_constant", &P::occluded_constant, "m", 0, 5,
               "A return nearer than the voxel's range plus this occludes it.");
  table.number("occluded_slope", &P::occluded_slope, "", 0, 1,
               "occluded_constant grows by this much with each metre of range.");
  table.flag("gaps", &P::gaps,
             "See through a voxel also in its own column, beside what is nearer.");
  table.number("gap_margin", &P::gap_margin, "m", 0, 100,
               "All returns of that column must be farther by this than those that occlude.",
               "gaps is true");
  table.number("free_constant", &P::free_constant, "scans", kMoreThanNone, 1000,
               "Scans that must see through a voxel to make it dynamic.");
  table.number("free_per_agree", &P::free_per_agree, "", 0, 10,
               "And this many more for each scan that agrees with it.");
  table.integer("static_agree", &P::static_agree, "scans", 1, 1000,
                "Scans that must agree to make a voxel static.");
}

void add_vote(Lines& table) {
  table.integer("vote_radius", &P::vote_radius, "voxels", 0, 8,
                "Half width of the cube of voxels that vote; 0 for no vote.");
  table.number("vote_share", &P::vote_share, "", kMoreThanNone, 1,
               "Share of dynamic voxels that makes a voxel dynamic.");
  table.number("vote_keep", &P::vote_keep, "", 0, 1,
               "Share of dynamic voxels below which a dynamic voxel is not.");
  table.number(
      "outlast", &P::outlast, "", 0, 10000,
      "A settled voxel is not outvoted if so many times as many scans agree with it as with "
      "the dynamic ones around it, or three times where beams only passed beside it; 0 for off.",
      "settled_scans > 0");
  table.integer("run_scans", &P::run_scans, "scans", 0, 1000,
                "A voxel is dynamic if so many scans in a row see through it before the first or "
                "after the last one that agrees; 0 for off.");
  table.number("run_range", &P::run_range, "m", 0, 500, "Range up to which those count.",
               "run_scans > 0");
  table.integer(
      "height_scans", &P::height_scans, "scans", 0, 10000,
      "Where so many scans agree, only those that agree, or see through the voxel between "
      "these, are heard that have a beam at the height of its points, or half a voxel "
      "above or below. Where three times as many agree, those before and after are heard that "
      "have one at the height of anything in its column. 0 for off.");
  table.flag("ground_evidence", &P::ground_evidence,
             "Ask the scans about ground, too; else it always stays.", kTerrain);
}

void add_objects(Lines& table) {
  table.flag("objects", &P::objects, "Decide on each cluster of a scan as a whole.");
  table.number("object_height", &P::object_height, "m", 0, 5,
               "Clusters consist of points at least this high.",
               "terrain is true and objects is true or terrain is true and low_points is true");
  table.number("cluster_gap", &P::cluster_gap, "m", 0.05, 5,
               "Points this near to each other are one cluster; one without another within a third "
               "of this is a lone drop.",
               kGaps);
  table.number("cluster_growth", &P::cluster_growth, "", 0, 1,
               "cluster_gap grows by this much with each metre of range.", kGaps);
  table.number("object_dynamic_share", &P::object_dynamic_share, "", 0, 1,
               "Share of dynamic points that makes a cluster dynamic.", kObjects);
  table.number("object_static_share", &P::object_static_share, "", 0, 1,
               "Share of dynamic points up to which a cluster is static.", kObjects);
  table.integer("object_points", &P::object_points, "points", 1, 1000,
                "So many dynamic points a cluster needs to be removed as a whole, or to count as "
                "dynamic for its track. One of no more points goes with a larger one beside it.",
                kObjects);
  table.integer("group_points", &P::group_points, "points", 1, 1000000,
                "A group of so many dynamic points stays dynamic in a static cluster. A cluster "
                "with so many of them that does not go is divided, and a part of it needs as many "
                "to be removed as a whole; one with fewer, but object_points of them, counts as "
                "dynamic for its track, which then does not mark it.",
                kObjects);
  table.integer("settled_scans", &P::settled_scans, "scans", 0, 10000,
                "A voxel that so many scans agree with is not outvoted if none saw through it, its "
                "points are left out when a mixed cluster is divided, and a scan is not heard that "
                "sees through it, between these, from much farther than the nearest of them. What "
                "is there more than so many scans before something comes or after it leaves does "
                "not go with its track, and what is there twice as many, not with its cluster. 0 "
                "for none of these.");
  table.flag("tracks", &P::tracks, "Follow dynamic clusters over scans.", kObjects);
  table.number("track_dynamic_share", &P::track_dynamic_share, "", 0, 1,
               "Share of a track's clusters that must be dynamic.", kTracks);
  table.number("track_slack", &P::track_slack, "", 0, 10,
               "How much longer than its length explains scans may agree on an object.", kTracks);
  table.number("track_width", &P::track_width, "m", 0, 100,
               "Wider clusters are not followed, and nothing beside them goes with them.",
               kObjects);
  table.integer("track_points", &P::track_points, "points", 1, 1000,
                "Smaller clusters are not followed.", kTracks);
  table.flag("low_points", &P::low_points, "Points near the ground follow what stands above them.",
             kTerrain);
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const ParameterTable<P> table = [] {
    Lines lines;
    add_when(lines);
    add_terrain(lines);
    add_evidence(lines);
    add_vote(lines);
    add_objects(lines);
    return lines.table;
  }();
  return table;
}

}  // namespace raymoval::raymoval_plus_method
