// SPDX-License-Identifier: MIT
#include "methods/peopleremover/peopleremover.h"

namespace raymoval {
namespace {

std::vector<std::string> notes() {
  return {
      "Sets of scan numbers per voxel are not kept but read off the scans' own points, which gives "
      "the same verdicts; memory is bounded by the map.",
      "maxrange_method = none follows whole beams, as 3DTK did before May 2020; its present "
      "version "
      "follows none there and removes nothing.",
      "maxrange_method = normals is the default here and the choice of 3DTK's own example; 3DTK's "
      "default is none.",
      "Points within the minimum range, which 3DTK drops, are answered for: static.",
      "A point within two voxel diagonals of the sensor has no beam; 3DTK takes the arc sine of a "
      "value above 1 there.",
      "The normal is towards the sensor where fewer than three points, or points on a line, would "
      "decide it; no beam passes its own point.",
      "A beam that crosses two voxel walls at once crosses them one by one, x before y before z; "
      "3DTK steps along both at once.",
      "reduce draws from cells of a cap's solid angle by seed, scan and point; 3DTK's threads "
      "share "
      "one generator.",
      "normal-method (only angle works), normal-knearest (without effect), and the values of "
      "maxrange-method that abort in 3DTK are left out.",
  };
}

}  // namespace

MethodEntry peopleremover_entry() {
  const std::string none = "none";
  MethodEntry entry;
  entry.name = "peopleremover";
  entry.sentence =
      "Frees voxels that a single beam of a scan passes through which has no point there, and "
      "removes the points in them.";
  entry.source =
      "Schauer and Nuechter: The Peopleremover - Removing Dynamic Objects From 3-D Point Cloud "
      "Data by Traversing a Voxel Occupancy Grid, RA-L 2018";
  entry.notes = notes();
  entry.variants = {
      {"normals", "Point shadows, voxels of 0.2 m: what its authors recommend.", false, {}},
      {"fine",
       "Point shadows, voxels of 0.1 m: 3DTK's default size.",
       false,
       {{"voxel_size", 0.1}}},
      {"none",
       "Whole beams, voxels of 0.2 m: nothing protects surfaces seen at a grazing angle.",
       false,
       {{"maxrange_method", none}}},
      {"plain",
       "Whole beams, voxels of 0.2 m, freed voxels only: comes nearest to the rows that papers "
       "print.",
       false,
       {{"maxrange_method", none}, {"subvoxel_accuracy", false}}},
      {"reduced",
       "As normals, one beam per cap of 0.01 rad.",
       false,
       {{"reduce_points", std::int64_t{1}}, {"reduce_angle", 0.01}}},
  };
  entry.bind(peopleremover_method::parameter_table(), peopleremover_method::make_peopleremover);
  return entry;
}

}  // namespace raymoval
