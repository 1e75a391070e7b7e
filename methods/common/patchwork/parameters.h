// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::patchwork {

/// Parameters of Patchwork++; defaults are those of its public program for KITTI. A method that
/// segments the ground derives its parameters from these, and adds them to its table by
/// `add_ground_parameters`.
struct GroundParameters {
  double sensor_height = 1.723;
  double ground_min_range = 2.7;
  double ground_max_range = 80.0;
  int bin_points = 10;
  int lowest_points = 20;
  int plane_rounds = 3;
  double seed_height = 0.125;
  double ground_distance = 0.125;
  double wall_seed_height = 0.25;
  double wall_distance = 0.1;
  double upright = 0.707;
  double noise_reflectance = 0.2;
  // Behaviour of the public program.
  bool public_height = true;
  bool public_axes = true;
};

/// Adds the parameters of the ground to the table of a method whose parameters derive from
/// `GroundParameters`.
template <class Method>
void add_ground_parameters(ParameterTable<Method>& table) {
  using P = GroundParameters;
  const auto given = [](const char* name) { return "'" + std::string(name) + "' of Patchwork++"; };
  table
      .number("sensor_height", &P::sensor_height,
              {"m", 0.05, 50, given("sensor_height"),
               "Height of the sensor above the ground at the first scan; later scans tell it anew.",
               "public_height is true"})
      .number(
          "ground_min_range", &P::ground_min_range,
          {"m", 0.1, 20, given("min_range"), "Nearer points (horizontal distance) are not ground."})
      .number("ground_max_range", &P::ground_max_range,
              {"m", 21, 500, given("max_range"),
               "Farther points are not ground; zones, rings and sectors of bins lie between."})
      .integer("bin_points", &P::bin_points,
               {"points", 1, 100000, given("num_min_pts"), "A bin with fewer has no ground."})
      .integer("lowest_points", &P::lowest_points,
               {"points", 1, 100000, given("num_lpr"),
                "So many lowest points of a bin have the mean height where its ground begins."})
      .integer("plane_rounds", &P::plane_rounds,
               {"", 1, 100, given("num_iter"),
                "Times that points near the plane are chosen and the plane is fitted to them; also "
                "the most walls that are taken out of a bin before."})
      .number("seed_height", &P::seed_height,
              {"m", 0.001, 10, given("th_seeds"),
               "Points less than this above that mean height seed the ground's plane."})
      .number("ground_distance", &P::ground_distance,
              {"m", 0.001, 10, given("th_dist"),
               "Points less than this above the plane are ground, and all below it."})
      .number(
          "wall_seed_height", &P::wall_seed_height,
          {"m", 0.001, 10, given("th_seeds_v"),
           "The same as seed_height, for the plane that tells whether a bin begins with a wall."})
      .number("wall_distance", &P::wall_distance,
              {"m", 0.001, 10, given("th_dist_v"),
               "Points at most so far from a wall's plane are no ground."})
      .number("upright", &P::upright,
              {"", 0, 0.999, given("uprightness_thr"),
               "A plane whose unit normal has no greater z is no ground."})
      .number("noise_reflectance", &P::noise_reflectance,
              {"", 0, 1000, given("RNR_intensity_thr"),
               "Of points far below the ground those with less reflectance are mirrored. Without "
               "reflectance, and with 0, none is."})
      .flag("public_height", &P::public_height,
            {.source = "not in Patchwork++",
             .sentence = "The sensor is sensor_height above the ground at first. Else the first "
                         "scan tells, by the planes that it has around the sensor."})
      .flag("public_axes", &P::public_axes,
            {.source = "the public program of MapCleaner",
             .sentence = "Sectors of bins begin at the world's x axis. Else they begin at the "
                         "sensor's, so that the way the world is turned changes nothing."});
}

}  // namespace raymoval::patchwork
