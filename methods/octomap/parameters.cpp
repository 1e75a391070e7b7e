// SPDX-License-Identifier: MIT
#include "methods/octomap/parameters.h"

#include "methods/octomap/octomap.h"

namespace raymoval {
namespace {

using Table = ParameterTable<OctomapParameters>;
using P = OctomapParameters;
constexpr const char* kLibrary = "liboctomap's default";
constexpr const char* kKth = "KTH port of OctoMap";
constexpr const char* kKthPcl = "PCL's default, not set by the KTH port";
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
              {"", 0.01, 0.99, kLibrary, "A cell is free, and its points go, below this."})
      .flag("lazy_eval", &P::lazy_eval,
            {.source = kLibrary,
             .sentence = "Neither merges equal leaves nor fills inner nodes; changes memory and "
                         "time, never an answer.",
             .acts_when = "never"});
}

void add_beams(Table& table) {
  table
      .number("maximum_range", &P::maximum_range,
              {"m", -1, 1000, "maxrange, liboctomap's default",
               "Longer beams are cut here and hit nothing; -1 is unlimited."})
      .number("minimum_range", &P::minimum_range,
              {"m", -1, 100, "minRange, KTH port of OctoMap",
               "Nearer points are not inserted, but still judged; off unless above 0."})
      .flag("discretise", &P::discretise,
            {.source = kLibrary,
             .sentence = "One beam per occupied cell, to its centre, in place of one per point."})
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
             .acts_when = "minimum_range > 0 or maximum_range > 0"});
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
               kGround})
      .integer("ground_iterations", &P::ground_iterations,
               {"", 1, 100000, kKthPcl, "At most so many planes are tried.", kGround})
      .number("ground_probability", &P::ground_probability,
              {"", 0.01, 0.999999, kKthPcl,
               "Tries end once a plane of inliers only was drawn this surely.", kGround})
      .integer("ground_points", &P::ground_points,
               {"points", 3, 1000000, kKth, "Scans with fewer points have no ground.", kGround});
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
               "Outliers are above the mean by so many standard deviations.", kNoise})
      .choice("noise_points", &P::noise_points,
              {{"occupied", NoisePoints::kOccupied}, {"removed", NoisePoints::kRemoved}},
              {.source = "KTH port: 2023 and 2024",
               .sentence = "Outliers hit their cells without a beam and are judged like other "
                           "points, or are taken out of scan and map.",
               .acts_when = kNoise});
}

std::vector<std::string> notes() {
  return {
      "The map is liboctomap's tree with the leaves that insertPointCloud makes of the same scans, "
      "kept to cells in which some scan has a point, for no other is asked for; the cells of a "
      "scan "
      "are computed and put in by faster code of our own.",
      "The tree's centre is the first scan's origin rounded to whole cells, so that coordinates "
      "stay exact in float far from the world's origin; the cells are those of the world's "
      "lattice.",
      "The verdict is given per point, of all points of all scans, not per cell centre.",
      "A point whose cell no scan touched stays unless remove_unknown is set; one outside the tree "
      "always stays, and its beam is left out.",
      "Scans go in by increasing index; clamping makes the answer depend on that order.",
      "With discretise, points outside the tree are left out, where liboctomap wraps them around.",
      "kth, ground and ground-noise keep the KTH port's settings (0.1 m, clamping at 0.12 and "
      "0.97), its missing subtraction, and its dropping of unknown points; the port's map appends "
      "ground points a second time, here each point has one verdict.",
      "The ground plane is fitted in world axes, as in the KTH port: z must point up, which the "
      "harness sees to.",
      "The KTH port of 2024 swaps the noise filter's two settings when reading them; ground-noise "
      "is the filter of 2023 (K = 50, S = 1).",
      "octomap_server's own ground filter (200 tries, planes accepted by their height in a base "
      "frame) is not offered: scans come without a base frame.",
  };
}

}  // namespace

const ParameterTable<OctomapParameters>& octomap_parameter_table() {
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

MethodEntry octomap_entry() {
  const Configuration kth = {{"resolution", 0.1},    {"clamp_min", 0.12},
                             {"clamp_max", 0.97},    {"kth_nonexclusive", true},
                             {"cut_end_free", true}, {"remove_unknown", true}};
  Configuration ground = kth;
  ground.emplace_back("ground", true);
  Configuration ground_noise = ground;
  ground_noise.emplace_back("noise", true);
  MethodEntry entry;
  entry.name = "octomap";
  entry.sentence =
      "Probabilistic occupancy map of hits and beams; a point goes if its cell ends up free.";
  entry.source =
      "Hornung et al., OctoMap: an efficient probabilistic 3D mapping framework based on octrees, "
      "Autonomous Robots 34, 2013; liboctomap 1.9";
  entry.notes = notes();
  entry.parameters = octomap_parameter_table().specs();
  entry.variants = {
      {"r20", "liboctomap's insertPointCloud with leaves of 0.2 m.", false, {}},
      {"r10", "The same with leaves of 0.1 m.", false, {{"resolution", 0.1}}},
      {"r05", "The same with leaves of 0.05 m.", false, {{"resolution", 0.05}}},
      {"discretised", "0.2 m, one beam per occupied cell.", false, {{"discretise", true}}},
      {"kth", "The KTH port's shipped setting: 0.1 m, hits do not suppress misses.", false, kth},
      {"ground", "The KTH port with its ground plane ('w G').", false, ground},
      {"ground-noise", "The KTH port with ground plane and noise filter ('w GF').", false,
       ground_noise},
  };
  entry.make = [](const Configuration& configuration) {
    return make_octomap(octomap_parameter_table().read(configuration));
  };
  return entry;
}

}  // namespace raymoval
