// SPDX-License-Identifier: MIT
#include "methods/raymoval/raymoval.h"

namespace raymoval {
namespace raymoval_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kOurs = "not in the paper";
// When parameters act.
constexpr const char* kValidate = "validate is true";

void add_grid(Table& table) {
  table
      .integer("azimuth_bins", &P::azimuth_bins,
               {"bins", 0, 7200, "eq. 2, Table 1",
                "Directions around the full circle; 0 takes the sensor's azimuth step."})
      .integer("elevation_bins", &P::elevation_bins,
               {"bins", 0, 3600, "eq. 2, Table 1",
                "Rows over the vertical field of view; 0 takes the sensor's mean beam distance."})
      .number(
          "elevation_margin", &P::elevation_margin,
          {"deg", 0, 10, kOurs,
           "Added to both ends of the sensor's vertical field of view; points outside are in no "
           "bin and stay static."})
      .number("voxel_size", &P::voxel_size, {"m", 0.02, 2, "Table 1", "Edge of a map voxel."})
      .number("maximum_range", &P::maximum_range,
              {"m", 1, 500, "eq. 7, Table 1", "Rays end here; points beyond stay static."})
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 20, kOurs,
               "Ego radius: nearer points are in no bin and nearer map voxels stop no ray."});
}

void add_tests(Table& table) {
  table
      .integer("neighbourhood", &P::neighbourhood,
               {"bins", 0, 10, "eq. 8, Table 1", "Radius r_n of the window of first hits."})
      .number("percentile", &P::percentile,
              {"", 0, 1, "eq. 9, Table 1", "Quantile q of the window in the forward test."})
      .number("tau0", &P::tau0,
              {"m", 0, 10, "eq. 11, Table 1", "Constant part of the forward test's margin."})
      .number("tau1", &P::tau1,
              {"", 0, 2, "eq. 11, Table 1 (printed in m, but a ratio)",
               "Part of the forward test's margin that grows with the point's range."})
      .number("erase_tau0", &P::erase_tau0,
              {"m", 0, 10, kOurs, "Constant part of the erase test's margin."})
      .number("erase_tau1", &P::erase_tau1,
              {"", 0, 2, kOurs, "Part of the erase test's margin that grows with the map's range."})
      .number("erase_height", &P::erase_height,
              {"voxels", 0, 10, kOurs,
               "Minimum change of the ray's height between the first hit and the return behind it; "
               "with less, both may be on one surface at a grazing angle."})
      .number("erase_height_limit", &P::erase_height_limit,
              {"m", 0, 100, kOurs,
               "Beyond this distance behind the first hit no change of height is required.",
               "erase_height > 0"})
      .number("erase_percentile", &P::erase_percentile,
              {"", 0, 1, "eq. 9 ('lower quantile' in the text)",
               "Quantile of the window of first hits in the erase test."})
      .integer("erase_azimuth_window", &P::erase_azimuth_window,
               {"bins", 0, 30, kOurs,
                "A voxel is erased only if no return within this many columns supports it."})
      .integer("erase_elevation_window", &P::erase_elevation_window,
               {"bins", -1, 100, kOurs,
                "A voxel is erased only if no return within this many rows supports it; -1 reaches "
                "the neighbouring beam, but at most 0.5 degrees."});
}

void add_validation_and_answer(Table& table) {
  table
      .flag("validate", &P::validate,
            {.source = "section 3, eqs 12-15",
             .sentence = "Validate each scan's candidates in range-adaptive clusters: online when "
                         "the scan arrives, offline against the final map."})
      .number("cluster_gap", &P::cluster_gap,
              {"m", 0.01, 5, "section 3 (no value)", "Distance that joins points at range 0.",
               kValidate})
      .number(
          "cluster_gap_growth", &P::cluster_gap_growth,
          {"", 0, 0.2, "section 3 (no value)", "Growth of that distance with range.", kValidate})
      .number("cluster_points", &P::cluster_points,
              {"points", 0, 1000, "eq. 13, m(r) (no value)",
               "Points a cluster needs at 10 m; falls with the square of the range, to 3 at least.",
               kValidate})
      .number("cluster_width", &P::cluster_width,
              {"m", 0, 5, "eq. 13, d(r) (no value)", "Width a cluster needs.", kValidate})
      .integer("group_gap", &P::group_gap,
               {"voxels", 1, 5, "section 3 (no value)", "Clusters nearer than this are one group.",
                kValidate})
      .integer("coverage_dilation", &P::coverage_dilation,
               {"voxels", 0, 5, "eq. 14, delta_v (no value)",
                "A point is covered if the static map is within this many voxels.", kValidate})
      .number("coverage_static", &P::coverage_static,
              {"", 0, 1.01, "eq. 15, theta_cov (no value)",
               "A group covered at least this much is static; above 1: never.", kValidate})
      .number("coverage_edge", &P::coverage_edge,
              {"", 0, 1.01, "eq. 15, theta_edge (no value)",
               "A thin group covered at least this much is static; above 1: never.",
               "validate is true and coverage_static > 0"})
      .number("thin_side", &P::thin_side,
              {"m", 0, 5, "eq. 15, theta_thin (no value)", "A group at most this thick is thin.",
               "validate is true and coverage_edge <= 1"})
      .integer("support_dilation", &P::support_dilation,
               {"voxels", 0, 5, "section 3, 'unsupported points' (no value)",
                "Reach of the neighbourhood in which a removed point may find static support.",
                "validate is true and support_share < 1"})
      .number("support_share", &P::support_share,
              {"", 0, 1, "section 3, 'unsupported points' (no value)",
               "In a dynamic cluster a point is supported, and kept, where at least this share of "
               "the voxels around it is static; 1: never.",
               kValidate})
      .integer("minimum_points", &P::minimum_points,
               {"points", 0, 1000, "m_min (no value)",
                "A cluster's remainder with fewer points is static.", kValidate})
      .number("minimum_width", &P::minimum_width,
              {"m", 0, 5, "d_min (no value)", "A cluster's remainder narrower than this is static.",
               kValidate})
      .flag("offline", &P::offline,
            {.source = kOurs,
             .sentence = "Answer for all points from the final map instead of scan by scan."});
}

Table make_table() {
  Table table;
  add_grid(table);
  add_tests(table);
  add_validation_and_answer(table);
  return table;
}

}  // namespace
}  // namespace raymoval_method

namespace {

std::vector<MethodVariant> raymoval_variants() {
  return {
      {.name = "offline", .sentence = "Tests every scan against the final map of all scans."},
      {.name = "online",
       .sentence = "Answers each scan when it arrives, from the map of the scans so far.",
       .online = true,
       .overrides = {{"offline", false}}},
      {.name = "table1",
       .sentence = "As offline, with every value as printed in Table 1.",
       .overrides = {{"erase_tau1", 0.35}, {"erase_percentile", 0.9}}},
      {.name = "table1-online",
       .sentence = "As online, with every value as printed in Table 1.",
       .online = true,
       .overrides = {{"offline", false}, {"erase_tau1", 0.35}, {"erase_percentile", 0.9}}},
  };
}

}  // namespace

MethodEntry raymoval_entry() {
  MethodEntry entry;
  entry.name = "raymoval";
  entry.sentence =
      "Casts rays against the map: flags points in front of it, erases voxels that a scan sees "
      "through, validates clusters of flagged points against the remaining map.";
  entry.source = "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping";
  entry.bibtex = R"(@misc{raymoval2025,
  title = {Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping},
  year = {2025},
  eprint = {2605.08937},
  archiveprefix = {arXiv},
  note = {RiTA 2025}
}
)";
  entry.version = "3";
  entry.notes = {
      "The paper leaves the erase test's margin, the origin of its map, and all cluster and "
      "coverage values open; table1 uses every printed value in both tests.",
      "The percentile is always one of the window's values (nearest rank).",
      "m(r) falls with the square of the range and d(r) is constant: the paper gives no form.",
  };
  entry.variants = raymoval_variants();
  entry.bind(raymoval_method::make_table(), raymoval_method::make_raymoval);
  return entry;
}

}  // namespace raymoval
