// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/parameters.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace raymoval::mapcleaner_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kPublic = "the public program";
constexpr const char* kKitti = "the public program's settings for KITTI";

void add_terrain(Table& table) {
  table.number("terrain_cell", &P::terrain_cell, {"m", 0.05, 2, kKitti, "Side of a terrain cell."})
      .integer("terrain_points", &P::terrain_points,
               {"points", 1, 100000, "1 for KITTI, 3 in its other settings",
                "A cell with fewer ground points has no height of its own."})
      .number("terrain_variance", &P::terrain_variance,
              {"m^2", 1e-6, 100, kPublic,
               "Nor has one whose ground points' heights have no smaller variance."})
      .number(
          "fill_radius", &P::fill_radius,
          {"m", 0, 5, kPublic,
           "Cells without a height get one from those with one that are nearer than this; 0 fills "
           "none."})
      .number("fill_deviation", &P::fill_deviation,
              {"m", 0.001, 100, kPublic,
               "Cells count less the more they deviate from the smooth ground around them: this "
               "is the deviation of their normal weight.",
               "fill_radius > 0"})
      .integer("fill_cells", &P::fill_cells,
               {"cells", 1, 10000, kPublic,
                "A cell with fewer such cells around it stays without height, here and when "
                "filling again.",
                "fill_radius > 0 or refill_radius > 0"})
      .number("terrain_slope", &P::terrain_slope,
              {"deg", 0.1, 90, kPublic,
               "Terrain is what can be reached from below the sensors through cells that are less "
               "steep; 90 lets all pass."})
      .number(
          "start_radius", &P::start_radius,
          {"m", 0, 50, "not in the public program",
           "Where no terrain is below a sensor, or it is too steep, the way begins at the nearest "
           "cells with terrain, if they are not farther than this. If most of the ground within "
           "this distance is too steep, slopes count from its median slope. 0: no way begins "
           "there."})
      .number("refill_radius", &P::refill_radius,
              {"m", 0, 5, kPublic, "The same as fill_radius, once the rest is dropped."})
      .number("refill_deviation", &P::refill_deviation,
              {"m", 0.001, 100, kPublic, "The same as fill_deviation.", "refill_radius > 0"});
}

void add_split(Table& table) {
  table
      .number("ground_height", &P::ground_height,
              {"m", 0, 10, kKitti,
               "Points at most so far above or below the terrain are ground and stay."})
      .flag("remove_below", &P::remove_below,
            {.source = "the public program saves them nowhere",
             .sentence = "Points farther below the terrain go."})
      .number("voxel_size", &P::voxel_size,
              {"m", 0.05, 2, kPublic,
               "Edge of a voxel, whose points are judged together, where their centroid is."});
}

void add_votes(Table& table) {
  table
      .number("column_width", &P::column_width,
              {"deg", 0.08, 10, kKitti, "Width of a pixel of a scan's range image."})
      .number("row_height", &P::row_height, {"deg", 0.08, 10, kKitti, "Height of a pixel."})
      .number(
          "vertical_view", &P::vertical_view,
          {"deg", 1, 180, kPublic,
           "Height of the images, half of it above the horizon. What lies beyond is not judged.",
           "public_field_of_view is true"})
      .integer("window_columns", &P::window_columns,
               {"pixels", 0, 20, kKitti,
                "A voxel is compared with so many columns to either side of its own."})
      .integer("window_rows", &P::window_rows,
               {"pixels", 0, 20, kKitti, "The same for rows, above and below."})
      .number("tolerance", &P::tolerance,
              {"m", 0.01, 10, kKitti,
               "A scan sees a voxel if a range in that window differs by no more. If all are "
               "larger, it sees through it."})
      .number("submap_radius", &P::submap_radius,
              {"m", 1, 500, kPublic, "Voxels within this distance of the sensor are compared."})
      .number("submap_travel", &P::submap_travel,
              {"m", 0, 500, kPublic,
               "They are chosen anew once the sensor has moved farther than this."});
}

void add_switches(Table& table) {
  table
      .flag("public_field_of_view", &P::public_field_of_view,
            {.source = kPublic,
             .sentence = "Images go all around and have vertical_view. Else they have the sensor's "
                         "field of view."})
      .flag("public_overwrite", &P::public_overwrite,
            {.source = kPublic,
             .sentence = "A pixel has the range of the last point in it. Else it has the nearest."})
      .flag("public_steps", &P::public_steps,
            {.source = kPublic,
             .sentence =
                 "Pixels and bins are set for the HDL-64E of KITTI. Else pixels are at least so "
                 "large that the window reaches over the angular steps of the sensor, and "
                 "bin_points and lowest_points are fewer by as much as its directions are "
                 "farther apart, but at least three."});
}

Table make_table() {
  Table table;
  patchwork::add_ground_parameters(table);
  add_terrain(table);
  add_split(table);
  add_votes(table);
  add_switches(table);
  return table;
}

/// How many times farther apart directions are than published, at least once.
double times_farther(double step, double published) {
  return step > 0.0 ? std::max(1.0, step / published) : 1.0;
}

/// A pixel, degrees, of which a window of `half` more to either side spans a step in radians.
double spanning(double pixel, int half, double step) {
  return std::max(pixel, step / kDegree / (2 * half + 1));
}

/// A number of points of a bin where only `share` of them is left.
int fewer(int points, double share) {
  constexpr int kPointsOfAPlane = 3;
  const int left = static_cast<int>(std::lround(points * share));
  return std::min(points, std::max(kPointsOfAPlane, left));
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

Parameters for_sensor(const Parameters& parameters, const SensorModel& sensor) {
  if (parameters.public_steps) return parameters;
  const SensorModel published = sensor_model_named("hdl64e");
  const double beams = times_farther(sensor.elevation_step, published.elevation_step);
  const double columns = times_farther(sensor.azimuth_step, published.azimuth_step);
  Parameters own = parameters;
  own.row_height = spanning(parameters.row_height, parameters.window_rows, sensor.elevation_step);
  own.column_width =
      spanning(parameters.column_width, parameters.window_columns, sensor.azimuth_step);
  own.bin_points = fewer(parameters.bin_points, 1.0 / (beams * columns));
  own.lowest_points = fewer(parameters.lowest_points, 1.0 / (beams * columns));
  return own;
}

}  // namespace raymoval::mapcleaner_method
