// SPDX-License-Identifier: MIT
#include "core/erasor_paper.h"
#include "methods/erasor/erasor.h"

namespace raymoval {
namespace erasor_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

void add_map(Table& table) {
  table
      .choice("body", &P::body, {{"sensor", Body::kSensor}, {"ground", Body::kGround}},
              {.source = "sensor in the public code",
               .sentence = "Frame of the bins: the sensor frame, lifted by sensor_height, or the "
                           "ground of the map around the sensor."})
      .number("sensor_height", &P::sensor_height,
              {"m", -10, 10, "lidar2body, 1.73 in all sets",
               "Height of the sensor above the road; heights below are above that road. With body "
               "= ground, used only where the map has no ground below the sensor."})
      .number(
          "min_range", &P::minimum_range,
          {"m", 0, 20, "naive map, 2.7 in the public code",
           "Nearer points (horizontal distance) are on the ego vehicle: in neither map nor query."})
      .number("map_voxel_size", &P::map_voxel_size,
              {"m", 0.02, 2, "0.2 in all sets; KTH port 0.1",
               "Edge of a voxel of the naive map, the unit that is removed."})
      .number("query_voxel_size", &P::query_voxel_size,
              {"m", 0.02, 2, "code 0.05; 0.2 in all sets; KTH port 0.1",
               "A query is thinned to one point per voxel of this edge."})
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
                "A bin with fewer points of the thinned query is not changed."})
      .flag("points_by_beams", &P::points_by_beams,
            {.source = "ours",
             .sentence = "minimum_num_pts is for the beam spacing of the HDL-64E and is reduced "
                         "for wider spacing."})
      .number("th_bin_max_h", &P::minimum_top,
              {"m", -50, 50, "code 0.39; sets 0.2 0.2 0.2 0.05 0.2",
               "Version 2: nothing is removed from a bin whose highest map point is not above this "
               "height above the road.",
               "version is 2"});
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
               {"", 1, 100, "3 in all sets", "Number of plane fits."})
      .number("gf_dist_thr", &P::ground_distance,
              {"m", 0.001, 10, "code 0.05; sets 0.15 0.15 0.15 0.15 0.125",
               "Points less than this above the plane are ground."});
}

Table make_table() {
  Table table;
  add_map(table);
  add_bins(table);
  add_ratio_test(table);
  add_ground(table);
  return table;
}

/// A variant lists only the values of its set that differ from the general set.
std::vector<MethodVariant> variants() {
  const auto text = [](const char* sequence) {
    return std::string("The authors' set of 2021 for KITTI ") + sequence + ".";
  };
  const Configuration kitti00 = {{"removal_interval", std::int64_t{4}},
                                 {"gf_num_lpr", std::int64_t{20}}};
  const Configuration kitti01 = {
      {"max_range", 60.0}, {"num_rings", std::int64_t{15}}, {"removal_interval", std::int64_t{1}}};
  const Configuration kitti02 = {{"min_h", -0.8}, {"max_h", 2.0}, {"gf_num_lpr", std::int64_t{20}}};
  const Configuration kitti05 = {{"max_range", 60.0},
                                 {"num_rings", std::int64_t{15}},
                                 {"num_sectors", std::int64_t{60}},
                                 {"max_h", 3.2},
                                 {"scan_ratio_threshold", 0.3},
                                 {"minimum_num_pts", std::int64_t{10}},
                                 {"th_bin_max_h", 0.05},
                                 {"removal_interval", std::int64_t{8}}};
  const Configuration kitti07 = {
      {"min_h", -0.8}, {"max_h", 3.1}, {"gf_dist_thr", 0.125}, {"num_lowest_pts", std::int64_t{1}}};
  return {
      {.name = "general",
       .sentence = "The median of the authors' five sets of 2021, value by value."},
      {.name = "kitti00", .sentence = text("00"), .overrides = kitti00},
      {.name = "kitti01", .sentence = text("01"), .overrides = kitti01},
      {.name = "kitti02", .sentence = text("02"), .overrides = kitti02},
      {.name = "kitti05", .sentence = text("05"), .overrides = kitti05},
      {.name = "kitti07", .sentence = text("07"), .overrides = kitti07},
      {.name = "fine",
       .sentence = "The general set with the voxels of 0.1 m that the KTH port works with.",
       .overrides = {{"map_voxel_size", 0.1}, {"query_voxel_size", 0.1}}},
      {.name = "version2",
       .sentence = "The general set with the order of operations that the paper describes.",
       .overrides = {{"version", std::int64_t{2}}}},
      {.name = "auto",
       .sentence = "The general set, with the ground around the sensor and the number of points in "
                   "a bin adapted to the data.",
       .overrides = {{"body", std::string("ground")}, {"points_by_beams", true}}},
  };
}

}  // namespace
}  // namespace erasor_method

MethodEntry erasor_entry() {
  MethodEntry entry;
  entry.name = "erasor";
  entry.version = "2";
  entry.sentence =
      "Compares the vertical extents of map and scan in polar bins: where that of the map is much "
      "larger, points above the fitted ground are removed.";
  entry.source =
      "ERASOR: Egocentric Ratio of Pseudo Occupancy-based Dynamic Object Removal for Static 3D "
      "Point Cloud Map Building, RA-L 2021";
  entry.bibtex = kErasorBibtex;
  entry.notes = {
      // The page of the method has all notes.
      "The map is a set of voxels on a lattice that no query moves, each with one fixed centroid "
      "and either in or out; the public map is a cloud that every query thins again and in which "
      "recovered ground occurs twice.",
      "A point has the verdict of its voxel, also a point nearer than min_range if another scan "
      "filled that voxel; else that point is kept.",
      "A query restores the voxels of the raw points that its thinned points in the bin represent.",
      "The plane's normal is turned upward; in the public code its sign is arbitrary, so that "
      "steep planes remove all points or none.",
      "Where the seeds lie on one line or point, the most upright plane through them is taken; "
      "the public code's is arbitrary.",
      "A bin without seeds loses nothing; the public code uses an uninitialised covariance there.",
      "Bins without a point left after num_lowest_pts take their lowest point as representative; "
      "the public code takes height zero.",
      "removal_interval counts the scans given: the sets of 00, 02, 05 and 07 expect every second "
      "frame of the drive, that of 01 every frame.",
  };
  entry.variants = erasor_method::variants();
  entry.bind(erasor_method::make_table(), erasor_method::make_erasor);
  return entry;
}

}  // namespace raymoval
