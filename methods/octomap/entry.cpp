// SPDX-License-Identifier: MIT
#include "methods/octomap/octomap.h"
#include "methods/octomap/point_filters.h"

namespace raymoval {
namespace {

std::vector<std::string> octomap_notes() {
  return {
      "The map is liboctomap's tree with the leaves that insertPointCloud makes of the same scans, "
      "kept to cells in which some scan has a point, for no other is asked for.",
      "The tree's centre is the first scan's origin rounded to whole cells, so that coordinates "
      "stay exact in float far from the world's origin; the cells are those of the world's "
      "lattice.",
      "The verdict is given per point, of all points of all scans, not per cell centre.",
      "A point whose cell no scan touched stays unless remove_unknown is set; one outside the tree "
      "always stays, and its beam is left out.",
      "Scans go in by increasing index; clamping makes the answer depend on that order.",
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

/// By scripts/calibrate.cpp over five simulated worlds of odd seeds, with five sensors. Of what
/// ends up free most is ground, hence the low end of the curve.
Calibration octomap_confidence() {
  return {
      "How likely a point's leaf is free (ground that is fitted never moves), by the curve of r20.",
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
      "Probabilistic occupancy map of hits and beams; a point goes if its cell ends up free.";
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
      {"r20", "liboctomap's insertPointCloud with leaves of 0.2 m.", false, {}},
      {"r05", "The same with leaves of 0.05 m.", false, {{"resolution", 0.05}}},
      {"kth", "The KTH port's shipped setting: 0.1 m, hits do not suppress misses.", false, kth},
      {"ground", "The KTH port with its ground plane ('w G')." + needs, false, ground, kHasPcl},
      {"ground-noise", "The KTH port with ground plane and noise filter ('w GF')." + needs, false,
       ground_noise, kHasPcl},
  };
  entry.bind(octomap_method::parameter_table(), octomap_method::make_octomap);
  return entry;
}

}  // namespace raymoval
