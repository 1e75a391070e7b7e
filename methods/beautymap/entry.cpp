// SPDX-License-Identifier: MIT
#include "methods/beautymap/beautymap.h"

namespace raymoval {

MethodEntry beautymap_entry() {
  const Configuration sound = {{"public_lattice", false},
                               {"public_outliers", false},
                               {"public_rays", false},
                               {"public_top", false}};
  Configuration wide = sound;
  wide.emplace_back("window_side", 100.0);
  wide.emplace_back("sight_range", 50.0);
  const Configuration indoor = {{"window_side", 10.0}, {"column_size", 0.5}, {"slice_height", 0.2}};
  MethodEntry entry;
  entry.name = "beautymap";
  entry.sentence =
      "Columns of bits: what the map has in a column and a scan has not, although it looks there, "
      "goes, down to the ground.";
  entry.source = "BeautyMap: Binary-Encoded Adaptable Ground Matrix (RA-L 2024)";
  entry.notes = {
      "The default is the public program with its quirks, each of which has a switch (public_...).",
      "A scan with nothing in the square around its sensor says nothing; the public program skips "
      "it as well.",
      "Where the square reaches beyond the map it is cut; the public program's arrays are shorter "
      "there.",
      "A point that stands straight above or below the sensor has no slope; the public program "
      "divides by zero.",
      "Coordinates are double precision; parts of a slice that begin at its upper end by rounding "
      "belong to the last one.",
      "Slices are told apart up to the 4,095th.",
  };
  entry.variants = {
      {"published", "As the public program is set for KITTI.", false, {}},
      {"semi-indoor", "The public program's settings for rooms.", false, indoor},
      {"sound", "Without the quirks of the public program.", false, sound},
      {"wide", "Without the quirks, and judging up to 50 m instead of 20.", false, wide},
  };
  entry.bind(beautymap_method::parameter_table(), beautymap_method::make_beautymap);
  return entry;
}

}  // namespace raymoval
