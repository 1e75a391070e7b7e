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
               "Height of the sensor above the ground at the first scan; later scans update it.",
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
                "Number of lowest points of a bin whose mean height is the lowest point "
                "representative."})
      .integer("plane_rounds", &P::plane_rounds,
               {"", 1, 100, given("num_iter"),
                "Iterations of choosing points near the plane and fitting it; also the maximum "
                "number of walls removed from a bin before."})
      .number("seed_height", &P::seed_height,
              {"m", 0.001, 10, given("th_seeds"),
               "Points less than this above that mean height seed the ground's plane."})
      .number("ground_distance", &P::ground_distance,
              {"m", 0.001, 10, given("th_dist"),
               "Points less than this above the plane are ground, and all below it."})
      .number(
          "wall_seed_height", &P::wall_seed_height,
          {"m", 0.001, 10, given("th_seeds_v"),
           "The same as seed_height, for the plane that decides whether a bin begins with a wall."})
      .number("wall_distance", &P::wall_distance,
              {"m", 0.001, 10, given("th_dist_v"),
               "Points within this distance of a wall's plane are not ground."})
      .number("upright", &P::upright,
              {"", 0, 0.999, given("uprightness_thr"),
               "A plane whose unit normal has at most this z is not ground."})
      .number("noise_reflectance", &P::noise_reflectance,
              {"", 0, 1000, given("RNR_intensity_thr"),
               "Points far below the ground with less reflectance than this are reflections. "
               "Without reflectance, or with 0, no point is."})
      .flag("public_height", &P::public_height,
            {.source = "not in Patchwork++",
             .sentence = "The sensor is sensor_height above the ground at first. Else the first "
                         "scan estimates it from the planes around the sensor."})
      .flag("public_axes", &P::public_axes,
            {.source = "the public program of MapCleaner",
             .sentence = "Sectors of bins begin at the world's x axis. Else they begin at the "
                         "sensor's, so that a rotation of the world changes nothing."});
}

}  // namespace raymoval::patchwork
