// SPDX-License-Identifier: MIT
#include "methods/freedom/freedom.h"

namespace raymoval {
namespace freedom_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kKitti = "KITTI settings of the public program";

Table make_table() {
  return Table()
      .number("sub_voxel_size", &P::sub_voxel_size,
              {"m", 0.02, 2, kKitti,
               "Edge of a sub-voxel, which holds one point. A voxel, which is free or not, has "
               "four along each edge."})
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
              {"m", 0, 1000, kKitti, "Rays end at this height above the sensor."})
      .integer("counts_to_free", &P::counts_to_free,
               {"scans", 1, 255, "KITTI settings; 3 for KITTI 01, Livox and rooms",
                "A voxel becomes free when rays of this many scans passed it and each of its 26 "
                "neighbours without a hit in between."})
      .integer("counts_to_revert", &P::counts_to_revert,
               {"scans", 1, 255, kKitti,
                "A voxel that is hit by this many scans without a passing ray in between is no "
                "longer free, nor are its 26 neighbours."})
      .flag("enhancement", &P::enhancement,
            {.source = "the publication",
             .sentence = "Rays are also cast where the scan has no return, if that area is open to "
                         "the top of its image, up to the range of its surroundings."})
      .number("image_maximum", &P::image_maximum,
              {"m", 1, 1000, "KITTI settings; 30 for Livox",
               "Farther points are not in the image, whose depth resolution is 1/255 of this.",
               "enhancement is true"});
}

}  // namespace
}  // namespace freedom_method

MethodEntry freedom_entry() {
  MethodEntry entry;
  entry.name = "freedom";
  entry.version = "2";
  entry.sentence =
      "A voxel is free if several scans in a row see through it and its neighbours; removes points "
      "in free voxels, and points near them unless another scan supports these.";
  entry.source = "FreeDOM: Online Dynamic Object Removal Framework (RA-L 2025)";
  entry.bibtex = R"(@article{li2025freedom,
  author = {Li, Chen and Li, Wanlei and Liu, Wenhao and Shu, Yixiang and Lou, Yunjiang},
  title = {{FreeDOM}: Online Dynamic Object Removal Framework for Static Map Construction Based
    on Conservative Free Space Estimation},
  journal = {IEEE Robotics and Automation Letters},
  year = {2025},
  volume = {10},
  number = {6},
  pages = {5577--5584},
  doi = {10.1109/LRA.2025.3560881}
}
)";
  entry.notes = {
      // The page of the method has all notes.
      "As in the public program, levels of the map grow by one round less than those of a scan, a "
      "voxel's neighbours keep their counts when it is no longer free, and scans that pass do not "
      "count in blocks of 8 x 8 x 8 voxels that are all free.",
      "The public program gives a map with one point in a sub-voxel; here a point is removed if "
      "its sub-voxel had a point of any scan and has no static one after the last scan.",
      "A point that is out of range in its own scan also has the verdict of its sub-voxel, and is "
      "kept if there never was a point in it.",
      "The image is that of the sensor's model (public settings: a file for each sensor).",
      "Columns of the image are as wide as its rows are high. If the sensor's directions are as "
      "far apart as its beams or farther, each has a column of its own.",
      "The top of the image is that of the sensor. Of one mounted upside down it shows the ground, "
      "so that rays would be cast where the ground gives no return: set enhancement=false there.",
      "The inpainting is written from its publication; OpenCV's rule for gradients is kept, its "
      "mixing in of unfilled pixels beside the first row and column is not.",
      "What the settings for KITTI do not use is left out: other neighbourhoods than 26, the mask "
      "image of a field of view, the erosion of holes, and least sizes of holes.",
  };
  entry.variants = {
      {.name = "published", .sentence = "As the public program is set for KITTI."},
      {.name = "few-counts",
       .sentence =
           "Three scans make a voxel free: the public settings for rooms, Livox and KITTI 01.",
       .overrides = {{"counts_to_free", std::int64_t{3}}}},
  };
  entry.bind(freedom_method::make_table(), freedom_method::make_freedom);
  return entry;
}

}  // namespace raymoval
