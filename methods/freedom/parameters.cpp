// SPDX-License-Identifier: MIT
#include "methods/freedom/parameters.h"

namespace raymoval::freedom_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kKitti = "KITTI settings of the public program";
constexpr const char* kQuirk = "the public program";
// When parameters act.
constexpr const char* kEnhanced = "enhancement is true";
constexpr const char* kOwnView = "enhancement is true and view_of_sensor is false";

void add_lattice(Table& table) {
  table
      .number("sub_voxel_size", &P::sub_voxel_size,
              {"m", 0.02, 2, kKitti, "Edge of a sub-voxel, which keeps one point."})
      .integer("sub_voxels", &P::sub_voxels,
               {"sub-voxels", 1, 4, kKitti,
                "Sub-voxels along an edge of a voxel, which is free or not."});
}

void add_reach(Table& table) {
  table
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 100, kKitti, "Nearer points are not put into the map."})
      .number("maximum_range", &P::maximum_range,
              {"m", 1, 1000, kKitti, "Farther points are not put into the map."})
      .number("lowest", &P::lowest,
              {"m", -1000, 0, kKitti,
               "Points further below the sensor are not put into the map (negative)."})
      .number("highest", &P::highest,
              {"m", 0, 1000, kKitti, "Points further above the sensor are not put into the map."})
      .number("ray_range", &P::ray_range, {"m", 1, 1000, kKitti, "Rays end here."})
      .number("ray_lowest", &P::ray_lowest,
              {"m", -1000, 0, kKitti, "Rays end at this height relative to the sensor (negative)."})
      .number("ray_highest", &P::ray_highest,
              {"m", 0, 1000, kKitti, "Rays end at this height above the sensor."});
}

void add_counts(Table& table) {
  table
      .integer("counts_to_free", &P::counts_to_free,
               {"scans", 1, 255, "KITTI settings; 3 for KITTI 01, Livox and rooms",
                "A voxel is free once it and its 26 neighbours were each passed by rays of so many "
                "scans without a hit in between."})
      .integer("counts_to_revert", &P::counts_to_revert,
               {"scans", 1, 255, kKitti,
                "A voxel that is hit by so many scans without being passed in between is not free "
                "any more, nor are its 26 neighbours."})
      .choice("conservative_neighbours", &P::conservative_neighbours,
              {{"6", Neighbours::k6}, {"18", Neighbours::k18}, {"26", Neighbours::k26}},
              {.source = kKitti,
               .sentence = "Neighbours of a conservative voxel that become moderate."})
      .choice("aggressive_neighbours", &P::aggressive_neighbours,
              {{"6", Neighbours::k6},
               {"18", Neighbours::k18},
               {"26", Neighbours::k26},
               {"80", Neighbours::k80},
               {"124", Neighbours::k124}},
              {.source = kKitti,
               .sentence = "Neighbours of a moderate voxel that become aggressive; 80 is 26 and "
                           "then 6 of those, 124 is 26 twice."});
}

void add_view(Table& table) {
  table
      .flag("enhancement", &P::enhancement,
            {.source = "the publication",
             .sentence = "Rays also go where the scan has no return, if this is open to the top of "
                         "its image, as far as its surroundings are away."})
      .flag("view_of_sensor", &P::view_of_sensor,
            {.source = "our choice for the settings for each sensor",
             .sentence = "The image has the field of view and the rows of the sensor's model, and "
                         "reaches no farther than it.",
             .acts_when = kEnhanced})
      .number("view_width", &P::view_width,
              {"deg", 1, 360, kKitti, "Width of the image, half of it to the left.", kOwnView})
      .number("view_top", &P::view_top,
              {"deg", -90, 90, kKitti, "Elevation of the image's first row.", kOwnView})
      .number("view_bottom", &P::view_bottom,
              {"deg", -90, 90, kKitti, "Elevation of the image's last row.", kOwnView})
      .integer("image_rows", &P::image_rows,
               {"rows", 2, 720, kKitti,
                "Rows of the image, unless they are the sensor's and its model knows its steps. "
                "Columns are as wide as rows are high, unless the sensor's directions are farther "
                "apart.",
                kEnhanced});
}

void add_image(Table& table) {
  table
      .number("image_minimum", &P::image_minimum,
              {"m", 0, 100, kKitti, "Nearer points are not in the image.", kEnhanced})
      .number(
          "image_maximum", &P::image_maximum,
          {"m", 1, 1000, "KITTI settings; 30 for Livox",
           "Farther points are not in the image, whose depths are 255th parts of this. It must be "
           "above image_minimum.",
           kEnhanced})
      .number("depth_margin", &P::depth_margin,
              {"m", 0, 100, kKitti,
               "Rays without a return end so much before the inpainted depth, in whole 255th parts "
               "of image_maximum.",
               kEnhanced})
      .integer("inpainting_radius", &P::inpainting_radius,
               {"pixels", 1, 20, kKitti, "A pixel is inpainted from those this near.", kEnhanced})
      .integer("hole_area", &P::hole_area,
               {"pixels", 0, 1000000, kKitti, "Holes of at most so many pixels are not used.",
                kEnhanced})
      .integer("top_margin", &P::top_margin,
               {"rows", 0, 100, kKitti,
                "A hole is open to the top if it reaches this row or one above.", kEnhanced});
}

void add_switches(Table& table) {
  table
      .flag("public_second_round", &P::public_second_round,
            {.source = kQuirk,
             .sentence = "In the map, levels never grow to the second round of "
                         "aggressive_neighbours, only in the scan. Else in both.",
             .acts_when = "aggressive_neighbours is 80 or aggressive_neighbours is 124"})
      .flag("public_revert", &P::public_revert,
            {.source = kQuirk,
             .sentence = "The neighbours that are no longer free with a voxel keep their counts of "
                         "passing scans. Else they count anew."})
      .flag("public_full_blocks", &P::public_full_blocks,
            {.source = kQuirk,
             .sentence = "In blocks of 8 x 8 x 8 voxels that are all free, scans that pass do not "
                         "count, and hits add up. Else they do, and a passing scan ends a run of "
                         "hits."})
      .flag("public_inpainting", &P::public_inpainting,
            {.source = "OpenCV, which the public program uses",
             .sentence = "Gradients add at most the square root of 2 to a pixel, with the wrong "
                         "sign, and pixels are rounded up. Else they are extrapolated as in "
                         "Telea's publication.",
             .acts_when = kEnhanced});
}

Table make_table() {
  Table table;
  add_lattice(table);
  add_reach(table);
  add_counts(table);
  add_view(table);
  add_image(table);
  add_switches(table);
  return table;
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace raymoval::freedom_method
