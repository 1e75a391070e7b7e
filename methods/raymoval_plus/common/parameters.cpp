// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/parameters.h"

namespace raymoval::raymoval_plus_method {
namespace {

using P = Parameters;
constexpr const char* kSource = "this project";
// When parameters act.
constexpr const char* kTerrain = "terrain is true";
constexpr const char* kObjects = "objects is true";
// The least value of a share. With 0, voxels would be dynamic without any dynamic one around them.
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
}

void add_terrain(Lines& table) {
  table.flag("terrain", &P::terrain, "Find the ground and keep its points.");
  table.number("terrain_cell", &P::terrain_cell, "m", 0.1, 5, "Edge of a ground column.", kTerrain);
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
  table.number("evidence_range_max", &P::evidence_range_max, "m", 1, 500,
               "Farther voxels are not tested, and farther points are in no cluster.");
  table.number("hit_distance", &P::hit_distance, "m", 0, 5,
               "A beam that crosses a voxel and ends this near to it hits it; 5 mm more for each "
               "metre of range.");
  table.number("pass_distance", &P::pass_distance, "m", 0, 5,
               "A beam that crosses a voxel and ends farther behind it than this passes it; 5 mm "
               "more for each metre of range.");
  table.number(
      "voxel_contradiction", &P::voxel_contradiction, "", kMoreThanNone, 1,
      "A voxel is dynamic if scans that pass it before its first or after its last hit are "
      "this share of these and up to ten hits.");
  table.integer("vote_radius", &P::vote_radius, "voxels", 0, 8,
                "Half width of the cube of voxels that vote; 0 for no vote.");
  table.number("vote_share", &P::vote_share, "", kMoreThanNone, 1,
               "Share of dynamic voxels that makes a voxel dynamic.");
}

void add_objects(Lines& table) {
  table.flag("objects", &P::objects, "Classify each cluster of a scan as a whole.");
  table.number("object_passes", &P::object_passes, "scans", 0, 4,
               "A cluster is dynamic if so many scans a point pass where it is before anything is "
               "there or after it left.",
               kObjects);
  table.number(
      "object_contradiction", &P::object_contradiction, "", 0, 1,
      "A cluster with a fifth of a pass a point is dynamic from this mean contradiction of "
      "its voxels on.",
      kObjects);
  table.integer("object_points", &P::object_points, "points", 1, 1000,
                "Points that a dynamic cluster needs. A cluster of at most this many points is "
                "removed with a larger one beside it.",
                kObjects);
  table.number("cluster_gap", &P::cluster_gap, "m", 0.05, 5,
               "Distance that joins points to a cluster; 1 cm more for each metre of range.",
               kObjects);
  table.flag("tracks", &P::tracks, "Track dynamic clusters over scans.", kObjects);
  table.number(
      "track_width", &P::track_width, "m", 0, 100,
      "Wider clusters are not tracked, and no small cluster beside them is removed with them.",
      kObjects);
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
    add_objects(lines);
    return lines.table;
  }();
  return table;
}

}  // namespace raymoval::raymoval_plus_method
