// SPDX-License-Identifier: MIT
#include "methods/beautymap/beautymap.h"

namespace raymoval {
namespace beautymap_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

Table make_table() {
  return Table()
      .number("column_size", &P::column_size,
              {"m", 0.1, 10, "'xy_resolution' of the public program", "Side of a column."})
      .number("slice_height", &P::slice_height,
              {"m", 0.1, 5, "'h_res'", "Height of a slice; a column has 31 of them."})
      .number("window_side", &P::window_side,
              {"m", 4, 400, "'dis_range'",
               "Side of the square around the sensor in which a scan is compared with the map."})
      .number("sight_range", &P::sight_range,
              {"m", 0, 400, "constant of the public program",
               "Beyond this range, columns in which the scan has no ground are not compared."})
      .flag("public_lattice", &P::public_lattice,
            {.source = "the public program",
             .sentence =
                 "Columns begin at the map's smallest x and y; the window around the sensor begins "
                 "at its position in whole metres and is one column short at its end. Else columns "
                 "are on the world's lattice, and the sensor's column is in the centre."})
      .flag("public_outliers", &P::public_outliers,
            {.source = "the public program",
             .sentence = "Neighbours are those with smaller x and y, after they were changed "
                         "themselves. Else they are all around, as measured."})
      .flag("public_rays", &P::public_rays,
            {.source = "the public program",
             .sentence = "Heights along rays walked backward add a difference in metres to slices, "
                         "and count slices of columns as if all columns began at one height. Else "
                         "they are heights."})
      .flag(
          "public_top", &P::public_top,
          {.source = "the public program",
           .sentence = "Of the slices above the 30th only the last counts, and a scan counts there "
                       "only if its column is also occupied below. Else all slices count."});
}

}  // namespace
}  // namespace beautymap_method

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
      "Encodes the heights of each column as bits: removes points above the ground that the map "
      "has and a scan that observes the column does not.";
  entry.source = "BeautyMap: Binary-Encoded Adaptable Ground Matrix (RA-L 2024)";
  entry.bibtex = R"(@article{jia2024beautymap,
  author = {Jia, Mingkai and Zhang, Qingwen and Yang, Bowen and Wu, Jin and Liu, Ming and
    Jensfelt, Patric},
  title = {{BeautyMap}: Binary-Encoded Adaptable Ground Matrix for Dynamic Points Removal in
    Global Maps},
  journal = {IEEE Robotics and Automation Letters},
  year = {2024},
  volume = {9},
  number = {7},
  pages = {6256--6263},
  doi = {10.1109/LRA.2024.3402625}
}
)";
  entry.notes = {
      // The page of the method has all notes.
      "The default is the public program with its quirks, each of which has a switch (public_...).",
      "A scan without points in the square around its sensor is skipped, as in the public program.",
      "A point straight above or below the sensor has no slope; the public program divides by "
      "zero.",
  };
  entry.variants = {
      {.name = "published", .sentence = "As the public program is set for KITTI."},
      {.name = "semi-indoor",
       .sentence = "The public program's settings for rooms.",
       .overrides = indoor},
      {.name = "sound",
       .sentence = "Without the quirks of the public program.",
       .overrides = sound},
      {.name = "wide",
       .sentence = "Without the quirks, and comparing up to 50 m instead of 20.",
       .overrides = wide,
       .developed_on = "KITTI raw drive 0005"},
  };
  entry.bind(beautymap_method::make_table(), beautymap_method::make_beautymap);
  return entry;
}

}  // namespace raymoval
