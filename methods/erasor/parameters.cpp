// SPDX-License-Identifier: MIT
#include "methods/erasor/parameters.h"

namespace raymoval::erasor_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

void add_map(Table& table) {
  table
      .choice("body", &P::body, {{"sensor", Body::kSensor}, {"ground", Body::kGround}},
              {.source = "sensor in the public code",
               .sentence = "The frame that bins lie in: that of the sensor, lifted by "
                           "sensor_height, or the ground that the map has around the sensor."})
      .number("sensor_height", &P::sensor_height,
              {"m", -10, 10, "lidar2body, 1.73 in all sets",
               "Height of the sensor above the road; heights below are above that road. With body "
               "= ground only where the map has none below the sensor."})
      .number("min_range", &P::minimum_range,
              {"m", 0, 20, "naive map, 2.7 in the public code",
               "Nearer points (horizontal distance) are the own car: in neither map nor query."})
      .number("map_voxel_size", &P::map_voxel_size,
              {"m", 0.02, 2, "0.2 in all sets; KTH port 0.1",
               "Edge of a voxel of the naive map, the unit that is removed."})
      .number("query_voxel_size", &P::query_voxel_size,
              {"m", 0.02, 2, "code 0.05; 0.2 in all sets; KTH port 0.1",
               "A query is thinned to one point a voxel of this edge."})
      .integer("removal_interval", &P::removal_interval,
               {"scans", 1, 100000, "code 2; sets 4 1 5 8 5", "Every n-th scan is a query."})
      .integer("phase", &P::phase,
               {"scans", -1, 100000, "n - 1 in the public code, 0 in the authors' second one",
                "Number of the first scan that is a query; -1 takes removal_interval - 1."});
}

void add_bins(Table& table) {
  table
      .number("max_range", &P::maximum_range,
              {"m", 1, 500, "code 10; sets 80 60 80 60 80", "Radius of the disc that is tested."})
      .integer("num_rings", &P::rings, {"bins", 1, 1000, "sets 20 15 20 15 20", "Rings of bins."})
      .integer("num_sectors", &P::sectors,
               {"bins", 1, 3600, "code 60; sets 108 108 108 60 108", "Sectors of each ring."})
      .number("min_h", &P::minimum_height,
              {"m", -50, 50, "code 0; sets -1.3 -1.3 -0.8 -1.3 -0.8",
               "Points at or below this height above the road are in no bin."})
      .number("max_h", &P::maximum_height,
              {"m", -50, 50, "sets 3.0 3.0 2.0 3.2 3.1",
               "Points at or above this height above the road are in no bin."});
}

void add_ratio_test(Table& table) {
  table
      .integer("version", &P::version,
               {"", 2, 3, "3 in all sets; 2 is the paper's, as its author says",
                "Order of operations of the scan ratio test."})
      .number("scan_ratio_threshold", &P::ratio_threshold,
              {"", 0, 1, "code 0.22; sets 0.2 0.2 0.2 0.3 0.2",
               "A bin is unequal if the lower extent over the higher one is below this."})
      .integer("minimum_num_pts", &P::minimum_points,
               {"points", 1, 100000, "code 4; sets 6 6 6 10 6",
                "A bin with fewer points of the thinned query is left alone."})
      .flag("points_by_beams", &P::points_by_beams,
            {.source = "ours",
             .sentence = "minimum_num_pts is for beams as near each other as those of the HDL-64E; "
                         "it is less where they are farther apart."})
      .number("min_object_height", &P::minimum_object_height,
              {"m", 0, 50, "0.5, a literal in the public code",
               "Version 3: nothing is removed from a bin whose map extent is not above this.",
               "version is 3"})
      .number("th_bin_max_h", &P::minimum_top,
              {"m", -50, 50, "code 0.39; sets 0.2 0.2 0.2 0.05 0.2",
               "Version 2: nothing is removed from a bin whose highest map point is not above this "
               "height above the road.",
               "version is 2"})
      .flag("reinsert", &P::reinsert,
            {.source = "true in the public code",
             .sentence = "What a query sees in a bin that it changes is put back into the map."});
}

void add_ground(Table& table) {
  table
      .integer("num_lowest_pts", &P::lowest_skipped,
               {"points", 0, 100000, "5 5 5 5 1", "Lowest points of a bin skipped as outliers."})
      .integer("gf_num_lpr", &P::lowest_averaged,
               {"points", 1, 100000, "sets 20 10 20 10 10",
                "Next lowest points whose mean height is the lowest point representative."})
      .number("gf_th_seeds_height", &P::seed_height,
              {"m", 0.001, 10, "0.5 in all sets",
               "Points less than this above the representative seed the ground plane."})
      .integer("gf_iter", &P::plane_iterations,
               {"", 1, 100, "3 in all sets", "Times that the plane is fitted."})
      .number("gf_dist_thr", &P::ground_distance,
              {"m", 0.001, 10, "code 0.05; sets 0.15 0.15 0.15 0.15 0.125",
               "Points less than this above the plane are ground."})
      .flag("require_upright", &P::require_upright,
            {.source = "a line commented out in the public code",
             .sentence = "Where a fitted plane is steeper than 45 degrees, the whole bin is ground "
                         "and stays."})
      .choice("sparse_ground", &P::sparse_ground,
              {{"lowest", SparseGround::kLowestPoint}, {"zero", SparseGround::kZero}},
              {.source = "zero in the public code",
               .sentence = "Lowest point representative of a bin that has no point left after "
                           "num_lowest_pts: the lowest point, or height zero.",
               .acts_when = "num_lowest_pts > 0"});
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = [] {
    Table t;
    add_map(t);
    add_bins(t);
    add_ratio_test(t);
    add_ground(t);
    return t;
  }();
  return table;
}

}  // namespace raymoval::erasor_method
