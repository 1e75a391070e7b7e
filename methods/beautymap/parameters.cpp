// SPDX-License-Identifier: MIT
#include "methods/beautymap/parameters.h"

namespace raymoval::beautymap_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

void add_lattice(Table& table) {
  table
      .number("column_size", &P::column_size,
              {"m", 0.1, 10, "'xy_resolution' of the public program", "Side of a column."})
      .number("slice_height", &P::slice_height,
              {"m", 0.1, 5, "'h_res'", "Height of a slice; a column has 31 of them."})
      .number("finest_slice", &P::finest_slice,
              {"m", 0.02, 1, "constant of the public program",
               "Height of the parts of a ground slice, if 31 of them are not higher."})
      .number("window_side", &P::window_side,
              {"m", 4, 400, "'dis_range'",
               "Side of the square around the sensor in which a scan judges the map."});
}

void add_protection(Table& table) {
  table
      .number("sight_range", &P::sight_range,
              {"m", 0, 400, "constant of the public program",
               "From here on columns in which the scan has no ground are not judged."})
      .number("blind_range", &P::blind_range,
              {"m", 0, 50, "constant of the public program",
               "Columns that are nearer to the sensor are not judged."})
      .integer("ray_margin", &P::ray_margin,
               {"columns", 0, 20, "constant of the public program",
                "What stands at most so far from the sensor, along x and y together, hides nothing "
                "from the rays that are walked backward."});
}

void add_ground(Table& table) {
  table
      .integer("outlier_neighbours", &P::outlier_neighbours,
               {"columns", 0, 20, "constant of the public program",
                "A column's lowest point is compared with those of its neighbours up to here."})
      .number("outlier_share", &P::outlier_share,
              {"", 0.01, 1, "constant of the public program",
               "Share of the neighbours that must have points to be compared with.",
               "outlier_neighbours > 0"})
      .number("outlier_deviations", &P::outlier_deviations,
              {"", 0, 100, "constant of the public program",
               "A lowest point further from the neighbours' median than so many times their median "
               "absolute deviation is moved to that distance.",
               "outlier_neighbours > 0"})
      .number("ground_share", &P::ground_share,
              {"", 0, 1, "constant of the public program",
               "Below what is removed, the parts of the slice that hold this share of its points, "
               "counted from below, are ground and stay; the parts above go too."});
}

void add_switches(Table& table) {
  table
      .flag("public_lattice", &P::public_lattice,
            {.source = "the public program",
             .sentence = "Columns begin at the map's least x and y, and the window around the "
                         "sensor begins at its position in whole metres and ends one column "
                         "earlier than it begins. Else columns are those of the world's lattice, "
                         "and the sensor's is in the middle."})
      .flag("public_outliers", &P::public_outliers,
            {.source = "the public program",
             .sentence = "The neighbours are those with smaller x and y, after they were moved "
                         "themselves. Else they are all around, as measured.",
             .acts_when = "outlier_neighbours > 0"})
      .flag("public_rays", &P::public_rays,
            {.source = "the public program",
             .sentence = "Heights along rays walked backward add a difference in metres to slices, "
                         "and count slices of columns as if all columns began at one height. Else "
                         "they are heights."})
      .flag("public_top", &P::public_top,
            {.source = "the public program",
             .sentence = "Of the slices above the 30th only the last counts, and a scan has "
                         "something there if the column has something below too. Else all do."});
}

Table make_table() {
  Table table;
  add_lattice(table);
  add_protection(table);
  add_ground(table);
  add_switches(table);
  return table;
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace raymoval::beautymap_method
