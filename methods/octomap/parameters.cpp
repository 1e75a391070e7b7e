// SPDX-License-Identifier: MIT
#include "methods/octomap/parameters.h"

namespace raymoval::octomap_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kLibrary = "liboctomap's default";
constexpr const char* kKth = "KTH port of OctoMap";
// When parameters act.
constexpr const char* kGround = "ground is true";
constexpr const char* kNoise = "noise is true";

void add_map(Table& table) {
  table
      .number("resolution", &P::resolution,
              {"m", 0.01, 5, "'OctoMap 0.2' of the published tables; KTH port: 0.1",
               "Edge of a leaf; the tree reaches 32768 leaves either way."})
      .number("prob_hit", &P::prob_hit,
              {"", 0.5, 0.999, kLibrary, "Probability that a cell with a return is occupied."})
      .number("prob_miss", &P::prob_miss,
              {"", 0.001, 0.5, kLibrary, "Probability that a cell a beam crosses is occupied."})
      .number("clamp_min", &P::clamp_min,
              {"", 0.0001, 0.5, "liboctomap's default; KTH port: 0.12",
               "A cell's probability never falls below this."})
      .number("clamp_max", &P::clamp_max,
              {"", 0.5, 0.9999, "liboctomap's default; KTH port: 0.97",
               "A cell's probability never rises above this."})
      .number("occupancy_threshold", &P::occupancy_threshold,
              {"", 0.01, 0.99, kLibrary, "A cell is free, and its points go, below this."});
}

void add_beams(Table& table) {
  table
      .number("maximum_range", &P::maximum_range,
              {"m", -1, 1000, "maxrange, liboctomap's default",
               "Longer beams are cut here and hit nothing; -1 is unlimited."})
      .flag("kth_nonexclusive", &P::kth_nonexclusive,
            {.source = kKth,
             .sentence = "A cell both crossed and hit in one scan gets the miss and then the hit, "
                         "where liboctomap lets the hit win."})
      .flag("cut_end_free", &P::cut_end_free,
            {.source = kKth,
             .sentence = "The cell in which maximum_range cuts a beam counts as crossed, too.",
             .acts_when = "maximum_range > 0"})
      .flag("remove_unknown", &P::remove_unknown,
            {.source = kKth,
             .sentence = "A point whose cell no scan has touched goes.",
             .acts_when = "maximum_range > 0"});
}

void add_ground(Table& table) {
  table
      .flag("ground", &P::ground,
            {.source = "KTH port, 'Octomap w G'",
             .sentence = "Finds a ground plane in each scan; its points only free their beams, and "
                         "always stay."})
      .number("ground_distance", &P::ground_distance,
              {"m", 0.001, 1, kKth, "Points this near to the plane are ground.", kGround})
      .number("ground_angle", &P::ground_angle,
              {"rad", 0, 1.57, kKth, "The plane's normal is this near to the z axis of the world.",
               kGround});
}

void add_noise(Table& table) {
  table
      .flag("noise", &P::noise,
            {.source = "KTH port, 'Octomap w GF'",
             .sentence = "Finds statistical outliers in each scan before anything else."})
      .integer(
          "noise_neighbours", &P::noise_neighbours,
          {"points", 1, 1000, "KTH port (2023): K", "Neighbours of the mean distance.", kNoise})
      .number("noise_sigma", &P::noise_sigma,
              {"", 0.01, 1000, "KTH port (2023): S",
               "Outliers are above the mean by so many standard deviations.", kNoise});
}

}  // namespace

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = [] {
    Table t;
    add_map(t);
    add_beams(t);
    add_ground(t);
    add_noise(t);
    return t;
  }();
  return table;
}

}  // namespace raymoval::octomap_method
