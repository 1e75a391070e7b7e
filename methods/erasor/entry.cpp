// SPDX-License-Identifier: MIT
#include "methods/erasor/erasor.h"

namespace raymoval {
namespace {

/// The values of a set that differ from the general one are all that a variant names.
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
      {"general", "The median of the authors' five sets of 2021, value by value.", false, {}},
      {"kitti00", text("00"), false, kitti00},
      {"kitti01", text("01"), false, kitti01},
      {"kitti02", text("02"), false, kitti02},
      {"kitti05", text("05"), false, kitti05},
      {"kitti07", text("07"), false, kitti07},
      {"fine",
       "The general set with the voxels of 0.1 m that the KTH port works with.",
       false,
       {{"map_voxel_size", 0.1}, {"query_voxel_size", 0.1}}},
      {"version2",
       "The general set with the order of operations that the paper describes.",
       false,
       {{"version", std::int64_t{2}}}},
      {"auto",
       "The general set with what it needs from the data: the ground around the sensor, and how "
       "few points its beams leave in a bin.",
       false,
       {{"body", std::string("ground")}, {"points_by_beams", true}}},
  };
}

std::vector<std::string> notes() {
  return {
      "The map is a set of voxels on a lattice that no query moves, each with one fixed centroid "
      "and "
      "either in or out; the public map is a cloud that every query thins again and in which "
      "recovered ground stands twice.",
      "A point answers through the voxel it lies in; points nearer than min_range too if another "
      "scan filled that voxel, else they stay.",
      "A query puts back the voxels of the raw points that its thinned points in the bin stand "
      "for.",
      "The plane's normal is turned upward; in the public code its sign is left to chance, which "
      "for "
      "steep planes decides between all and nothing.",
      "Where the seeds lie on one line or point, the most upright plane through them is taken; the "
      "public code's is arbitrary.",
      "A bin without seeds loses nothing; the public code uses an uninitialised covariance there.",
      "Bins without a point left after num_lowest_pts take their lowest point as representative "
      "(sparse_ground = zero restores the public code's).",
      "The own car's points are left out of the query as well as of the map.",
      "The disc is found through 5 m tiles; the public code passes over the whole map at every "
      "query, "
      "which is quadratic in the length of the drive.",
      "Version 3's blocked bins are left out: they end like any other bin that is kept.",
      "rejection_ratio and voxelization_interval are read but never used by the public code, and "
      "are left out.",
      "removal_interval counts the scans given: the sets of 00, 02, 05 and 07 expect every second "
      "frame of the drive, that of 01 every frame.",
  };
}

}  // namespace

MethodEntry erasor_entry() {
  MethodEntry entry;
  entry.name = "erasor";
  entry.version = "2";
  entry.sentence =
      "Vertical extents of polar bins: where the map reaches much higher than the scan, what "
      "stands above the fitted ground goes.";
  entry.source =
      "ERASOR: Egocentric Ratio of Pseudo Occupancy-based Dynamic Object Removal for Static 3D "
      "Point Cloud Map Building, RA-L 2021";
  entry.notes = notes();
  entry.variants = variants();
  entry.bind(erasor_method::parameter_table(), erasor_method::make_erasor);
  return entry;
}

}  // namespace raymoval
