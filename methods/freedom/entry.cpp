// SPDX-License-Identifier: MIT
#include "methods/freedom/freedom.h"

namespace raymoval {

MethodEntry freedom_entry() {
  const std::int64_t few = 3;
  const Configuration sound = {{"public_second_round", false},
                               {"public_revert", false},
                               {"public_full_blocks", false},
                               {"public_inpainting", false}};
  MethodEntry entry;
  entry.name = "freedom";
  entry.version = "2";
  entry.sentence =
      "Free voxels: what stands where scan after scan looked through, with all its surroundings, "
      "goes, and its neighbours go unless another scan saw them.";
  entry.source = "FreeDOM: Online Dynamic Object Removal Framework (RA-L 2025)";
  entry.notes = {
      "The default is the public program with its quirks, each of which has a switch (public_...).",
      "The public program gives a map with one point in a sub-voxel; here a point goes if its "
      "sub-voxel had a point of any scan and has no static one after the last scan.",
      "A point that is out of range in its own scan is answered by its sub-voxel, too, and stays "
      "if "
      "there never was a point in it.",
      "Heights of points and rays are measured along the world's z; ranges are distances in space.",
      "The image is that of the sensor's model (public settings: a file for each sensor).",
      "Columns of the image are as wide as its rows are high. If the sensor's directions are as "
      "far "
      "apart as its beams or farther, each has a column of its own.",
      "The top of the image is that of the sensor. Of one mounted upside down it shows the ground, "
      "so that rays would go where the ground gives no return: set enhancement=false there.",
      "Depths are rounded down to grey levels. A pixel's ray goes through its middle.",
      "Holes are joined behind a full turn.",
      "The inpainting is written from its publication; OpenCV's rule for gradients is kept, its "
      "mixing in of unfilled pixels beside the first row and column is not.",
      "The mask image of a field of view and the erosion of holes, which the settings for KITTI do "
      "not use, are left out.",
      "Voxels become free once all rays of a scan are counted; only voxels that the scan passes "
      "do.",
      "Without public_revert, only neighbours that were free count anew.",
      "Mean points are sums of whole numbers, so that the order of points does not matter; poses "
      "stay in double precision.",
      "A ray that passes exactly through an edge crosses x before y before z.",
  };
  entry.variants = {
      {"published", "As the public program is set for KITTI.", false, {}},
      {"few-counts",
       "Three scans make a voxel free: the public settings for rooms, Livox and KITTI 01.",
       false,
       {{"counts_to_free", few}}},
      {"sound", "Without the quirks of the public program.", false, sound},
  };
  entry.bind(freedom_method::parameter_table(), freedom_method::make_freedom);
  return entry;
}

}  // namespace raymoval
