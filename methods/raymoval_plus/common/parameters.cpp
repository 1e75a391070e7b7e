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
             "Answer each scan once, when it arrives or a fixed time later (delay).");
  table.flag("one_pass", &P::one_pass,
             "Collect the evidence in one pass over the scans; answer at the end.",
             "at_once is false");
  table.number("delay", &P::delay, "s", 0, 10,
               "Each scan is answered this long after it, from all scans up to then.",
               "at_once is true");
  table.integer("recent_scans", &P::recent_scans, "scans", 0, 1000,
                "Number of earlier scans whose objects are reconsidered to find tracks.",
                "at_once is true and objects is true and tracks is true");
  table.integer("history_scans", &P::history_scans, "scans", 0, 1000,
                "Number of earlier scans that are kept as evidence for new voxels.",
                "at_once is true or one_pass is true");
  table.integer("history_step", &P::history_step, "scans", 1, 1000, "Every n-th scan is kept.",
                "at_once is true and history_scans > 0 or one_pass is true and history_scans > 0");
  table.integer("terrain_period", &P::terrain_period, "scans", 1, 1000,
                "Number of scans after which the ground is estimated again.",
                "terrain is true and at_once is true or terrain is true and one_pass is true");
}

void add_terrain(Lines& table) {
  table.flag("terrain", &P::terrain, "Find the ground and keep its points.");
  table.number("terrain_cell", &P::terrain_cell, "m", 0.1, 5, "Edge of a ground column.", kTerrain);
  table.number("terrain_quantile", &P::terrain_quantile, "", 0, 0.5,
               "Quantile of a column's heights that is its ground height.", kTerrain);
  table.number("terrain_drop", &P::terrain_drop, "m", 0, 10,
               "A column this much below its neighbours' quartile is dropped.", kTerrain);
  table.number(
      "terrain_slope", &P::terrain_slope, "", 0, 2,
      "Largest slope from a column to its neighbours, relative to the slope of the terrain.",
      kTerrain);
  table.number("terrain_reach", &P::terrain_reach, "m", 0, 10,
               "Distance up to which a column's ground bounds that of its neighbours.", kTerrain);
  table.number(
      "terrain_far_slope", &P::terrain_far_slope, "", 0, 2,
      "Largest slope over up to 22 columns, relative to the slope of the terrain; 0 for any.",
      kTerrain);
  table.number("ground_height", &P::ground_height, "m", 0, 1,
               "Points lower than this above the ground are ground.", kTerrain);
}

void add_evidence(Lines& table) {
  table.number("voxel_size", &P::voxel_size, "m", 0.02, 2, "Edge of a voxel.");
  table.number("minimum_range", &P::minimum_range, "m", 0, 20,
               "Nearer returns are on the ego vehicle and not in range images, but in terrain, "
               "voxels and clusters.");
  table.number("evidence_range_min", &P::evidence_range_min, "m", 0, 50,
               "Nearer voxels are not tested.");
  table.number(
      "evidence_range_max", &P::evidence_range_max, "m", 1, 500,
      "Farther voxels are not tested, and farther points are in no cluster and not lone drops.");
  table.number("azimuth_bin", &P::azimuth_bin, "deg", 0, 5,
               "Width of a bin of the range image; 0 takes 1.45 beams.");
  table.number("elevation_bin", &P::elevation_bin, "deg", 0, 5,
               "Height of a bin of the range image; 0 takes half a beam.");
  table.integer("window_columns", &P::window_columns, "bins", 0, 30,
                "Least half width of the window around a voxel.");
  table.integer("window_rows", &P::window_rows, "bins", 0, 60,
                "Least half height of the window around a voxel.");
  table.number("voxel_share", &P::voxel_share, "", 0, 1, "x");
  table.number("object_score", &P::object_score, "", 0, 1, "x");
  table.number("part_score", &P::part_score, "", 0, 1, "x");
  table.number("firm_share", &P::firm_share, "", 0, 1, "x");
  table.flag("soft", &P::soft, "x");
  table.number("soft_gap", &P::soft_gap, "", 0, 9, "x");
  table.number("soft_times", &P::soft_times, "", 0, 99, "x");
  table.number("sure_score", &P::sure_score, "", 0, 99, "x");
  table.flag("whole", &P::whole, "x");
  table.flag("lasting", &P::lasting, "x");
  table.number("agree_constant", &P::agree_constant, "m", 0, 5,
               "A return this near to the voxel's range supports the voxel. In tracks, the length "
               "of an object is increased by twice this.");
  table.number("agree_slope", &P::agree_slope, "", 0, 1,
               "Increase of agree_constant per metre of range.");
  table.number("occluded_constant", &P::occluded_constant, "m", 0, 5,
               "A return nearer than the voxel's range plus this occludes it.");
  table.number("occluded_slope", &P::occluded_slope, "", 0, 1,
               "Increase of occluded_constant per metre of range.");
  table.flag("gaps", &P::gaps,
             "A scan also sees through a voxel if the bins of the voxel's own column are free, "
             "beside nearer returns.");
  table.number("gap_margin", &P::gap_margin, "m", 0, 100,
               "Returns of that column must be farther than the occluding returns by this.",
               "gaps is true");
  table.number("free_constant", &P::free_constant, "scans", kMoreThanNone, 1000,
               "Scans that must see through a voxel to make it dynamic.");
  table.number("free_per_agree", &P::free_per_agree, "", 0, 10,
               "Increase of free_constant per scan that supports the voxel.");
  table.integer("static_agree", &P::static_agree, "scans", 1, 1000,
                "Scans that must support a voxel to make it static.");
}

void add_vote(Lines& table) {
  table.integer("vote_radius", &P::vote_radius, "voxels", 0, 8,
                "Half width of the cube of voxels that vote; 0 for no vote.");
  table.number("vote_share", &P::vote_share, "", kMoreThanNone, 1,
               "Share of dynamic voxels that makes a voxel dynamic.");
  table.number("vote_keep", &P::vote_keep, "", 0, 1,
               "Share of dynamic voxels below which a dynamic voxel becomes static.");
  table.number(
      "outlast", &P::outlast, "", 0, 10000,
      "A settled voxel is not outvoted if this many times more scans support it than the dynamic "
      "voxels around it, or three times more where beams only passed beside it; 0: off.",
      "settled_scans > 0");
  table.integer("run_scans", &P::run_scans, "scans", 0, 1000,
                "A voxel is dynamic if this many scans in a row see through it before the first or "
                "after the last scan that supports it; 0: off.");
  table.number("run_range", &P::run_range, "m", 0, 500,
               "Range up to which the scans of run_scans count.", "run_scans > 0");
  table.integer("height_scans", &P::height_scans, "scans", 0, 10000,
                "If this many scans support a voxel, scans between the first and the last of them "
                "count only with a beam at the height of its points, half a voxel up or down. If "
                "three times as many support it, scans before and after count only with a beam at "
                "the height of any point in its column. 0: off.");
  table.flag("ground_evidence", &P::ground_evidence,
             "Also collect evidence for ground; else it is always kept.", kTerrain);
}

void add_objects(Lines& table) {
  table.flag("objects", &P::objects, "Classify each cluster of a scan as a whole.");
  table.number("object_height", &P::object_height, "m", 0, 5,
               "Clusters consist of points at least this high.",
               "terrain is true and objects is true or terrain is true and low_points is true");
  table.number("cluster_gap", &P::cluster_gap, "m", 0.05, 5,
               "Distance that joins points to a cluster; a point without another within a third of "
               "this is a lone drop.",
               kGaps);
  table.number("cluster_growth", &P::cluster_growth, "", 0, 1,
               "Increase of cluster_gap per metre of range.", kGaps);
  table.number("object_dynamic_share", &P::object_dynamic_share, "", 0, 1,
               "Share of dynamic points that makes a cluster dynamic.", kObjects);
  table.number("object_static_share", &P::object_static_share, "", 0, 1,
               "Share of dynamic points up to which a cluster is static.", kObjects);
  table.integer(
      "object_points", &P::object_points, "points", 1, 1000,
      "Dynamic points that a cluster needs to be removed as a whole, or to count as dynamic for "
      "its track. A cluster of at most this many points is removed with a larger one beside it.",
      kObjects);
  table.integer("group_points", &P::group_points, "points", 1, 1000000,
                "A group of this many dynamic points stays dynamic in a static cluster. A cluster "
                "with this many dynamic points that is not removed is divided, and a part needs as "
                "many to be removed as a whole; a part with fewer, but object_points of them, "
                "counts as dynamic for its track, which then does not mark it.",
                kObjects);
  table.integer(
      "settled_scans", &P::settled_scans, "scans", 0, 10000,
      "A voxel that this many scans support is not outvoted if no scan saw through it, its points "
      "are left out when a mixed cluster is divided, and free observations between these scans "
      "from much farther than the nearest of them are ignored. Points present for more than this "
      "many scans before an object comes or after it leaves are not removed with its track, and "
      "for twice as many, not with its cluster. 0: none of these.");
  table.flag("tracks", &P::tracks, "Track dynamic clusters over scans.", kObjects);
  table.number("track_dynamic_share", &P::track_dynamic_share, "", 0, 1,
               "Share of a track's clusters that must be dynamic.", kTracks);
  table.number(
      "track_slack", &P::track_slack, "", 0, 10,
      "Factor by which scans may support an object longer than its length and speed explain.",
      kTracks);
  table.number(
      "track_width", &P::track_width, "m", 0, 100,
      "Wider clusters are not tracked, and no small cluster beside them is removed with them.",
      kObjects);
  table.integer("track_points", &P::track_points, "points", 1, 1000,
                "Smaller clusters are not tracked.", kTracks);
  table.flag("low_points", &P::low_points,
             "Points near the ground get the verdict of the points above them.", kTerrain);
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
