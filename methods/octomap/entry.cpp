// SPDX-License-Identifier: MIT
#include "methods/octomap/octomap.h"
#include "methods/octomap/point_filters.h"

namespace raymoval {
namespace octomap_method {
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
              {"", 0.01, 0.99, kLibrary, "A cell below this is free, and its points are removed."});
}

void add_beams(Table& table) {
  table
      .number("maximum_range", &P::maximum_range,
              {"m", -1, 1000, "maxrange, liboctomap's default",
               "Longer beams are truncated here and hit nothing; -1 is unlimited."})
      .flag("kth_nonexclusive", &P::kth_nonexclusive,
            {.source = kKth,
             .sentence = "A cell that is crossed and hit in one scan gets a miss and a hit; in "
                         "liboctomap only the hit counts."})
      .flag("cut_end_free", &P::cut_end_free,
            {.source = kKth,
             .sentence = "The cell in which maximum_range truncates a beam also counts as crossed.",
             .acts_when = "maximum_range > 0"})
      .flag("remove_unknown", &P::remove_unknown,
            {.source = kKth,
             .sentence = "Points in cells without any observation are removed.",
             .acts_when = "maximum_range > 0"});
}

void add_filters(Table& table) {
  table
      .flag("ground", &P::ground,
            {.source = "KTH port, 'Octomap w G'",
             .sentence = "Fits a ground plane in each scan; its points only free the cells along "
                         "their beams, and are always kept."})
      .number("ground_distance", &P::ground_distance,
              {"m", 0.001, 1, kKth, "Points this near to the plane are ground.", kGround})
      .number("ground_angle", &P::ground_angle,
              {"rad", 0, 1.57, kKth, "The plane's normal is this near to the z axis of the world.",
               kGround})
      .flag("noise", &P::noise,
            {.source = "KTH port, 'Octomap w GF'",
             .sentence = "Finds statistical outliers in each scan before anything else."})
      .integer(
          "noise_neighbours", &P::noise_neighbours,
          {"points", 1, 1000, "KTH port (2023): K", "Neighbours of the mean distance.", kNoise})
      .number("noise_sigma", &P::noise_sigma,
              {"", 0.01, 1000, "KTH port (2023): S",
               "Points with a mean distance above the mean by this many standard deviations are "
               "outliers.",
               kNoise});
}

Table make_table() {
  Table table;
  add_map(table);
  add_beams(table);
  add_filters(table);
  return table;
}

}  // namespace
}  // namespace octomap_method

namespace {

std::vector<std::string> octomap_notes() {
  return {
      "The map is liboctomap's tree with the leaves that insertPointCloud makes of the same scans, "
      "limited to cells in which some scan has a point.",
      "The tree's centre is the first scan's origin rounded to whole cells, so that coordinates "
      "stay exact in float far from the world's origin; the cells are those of the world's "
      "lattice.",
      "The verdict is given per point, of all points of all scans, not per cell centre.",
      "A point in a cell without any observation is kept unless remove_unknown is set; a point "
      "outside the tree is always kept, and its beam is left out.",
      "Scans are inserted by increasing index; clamping makes the result depend on that order.",
      "kth, ground and ground-noise keep the KTH port's settings (0.1 m, clamping at 0.12 and "
      "0.97), its missing subtraction, and its dropping of unknown points; the port's map appends "
      "ground points a second time, here each point has one verdict.",
      "The ground plane is fitted in world axes, as in the KTH port: z must point up, which the "
      "harness ensures.",
      "The KTH port of 2024 swaps the noise filter's two settings when reading them; ground-noise "
      "is the filter of 2023 (K = 50, S = 1).",
      "octomap_server's own ground filter (200 tries, planes accepted by their height in a base "
      "frame) is not offered: scans come without a base frame.",
  };
}

/// Fitted to five simulated worlds of development seeds, with five sensors. Most free points are
/// ground, hence the low end of the curve.
Calibration octomap_confidence() {
  return {"How likely a point's leaf is free (fitted ground never moves), by the curve of r20.",
          {{0.0292F, 0.0035F},
           {0.0429F, 0.0046F},
           {0.1316F, 0.0090F},
           {0.2610F, 0.0189F},
           {0.4388F, 0.0273F},
           {0.5426F, 0.0311F},
           {0.6456F, 0.0613F},
           {0.7924F, 0.0758F},
           {0.8730F, 0.0900F},
           {0.8808F, 0.2204F}}};
}

}  // namespace

MethodEntry octomap_entry() {
  const Configuration kth = {{"resolution", 0.1},    {"clamp_min", 0.12},
                             {"clamp_max", 0.97},    {"kth_nonexclusive", true},
                             {"cut_end_free", true}, {"remove_unknown", true}};
  Configuration ground = kth;
  ground.emplace_back("ground", true);
  Configuration ground_noise = ground;
  ground_noise.emplace_back("noise", true);
  constexpr bool kHasPcl = octomap_method::kHasPcl;
  const std::string needs = kHasPcl ? "" : " It needs PCL, which this build lacks.";
  MethodEntry entry;
  entry.name = "octomap";
  entry.sentence =
      "Estimates the occupancy probability of cells from hits and beams; removes points in cells "
      "that are free at the end.";
  entry.source =
      "Hornung et al., OctoMap: an efficient probabilistic 3D mapping framework based on octrees, "
      "Autonomous Robots 34, 2013; liboctomap 1.9";
  entry.bibtex = R"(@article{hornung2013octomap,
  author = {Hornung, Armin and Wurm, Kai M. and Bennewitz, Maren and Stachniss, Cyrill and
    Burgard, Wolfram},
  title = {{OctoMap}: An Efficient Probabilistic 3D Mapping Framework Based on Octrees},
  journal = {Autonomous Robots},
  year = {2013},
  volume = {34},
  number = {3},
  pages = {189--206},
  doi = {10.1007/s10514-012-9321-0}
}
)";
  entry.notes = octomap_notes();
  entry.confidence = octomap_confidence();
  entry.variants = {
      {.name = "r20", .sentence = "liboctomap's insertPointCloud with leaves of 0.2 m."},
      {.name = "r05",
       .sentence = "The same with leaves of 0.05 m.",
       .overrides = {{"resolution", 0.05}}},
      {.name = "kth",
       .sentence = "The KTH port's shipped setting: 0.1 m, hits do not suppress misses.",
       .overrides = kth},
      {.name = "ground",
       .sentence = "The KTH port with its ground plane ('w G')." + needs,
       .overrides = ground,
       .is_available = kHasPcl},
      {.name = "ground-noise",
       .sentence = "The KTH port with ground plane and noise filter ('w GF')." + needs,
       .overrides = ground_noise,
       .is_available = kHasPcl},
  };
  entry.bind(octomap_method::make_table(), octomap_method::make_octomap);
  return entry;
}

}  // namespace raymoval
