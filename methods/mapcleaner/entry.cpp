// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/mapcleaner.h"

namespace raymoval {
namespace {

std::vector<std::string> mapcleaner_notes() {
  return {
      "The default is the public program set for KITTI, whose ground segmentation is "
      "Patchwork++ instead of the paper's; its quirks have switches (public_...).",
      "Dynamic is what is voted dynamic. The public program saves what lies below the terrain "
      "nowhere, so that it goes (remove_below); what has no terrain it saves in a file of its "
      "own as neither static nor dynamic, so that it stays.",
      "Scans are not thinned before they come into the map, which the public program may do.",
      "Voxels and terrain cells are those of the lattice at the world's origin.",
      "Patchwork++: variances are those of the sample; where only one plane is known, its "
      "deviation is 0; where no plane of a ring is low enough, none is taken for being like "
      "them; a bin all of whose points lie below 1.2 sensor heights begins with all of them.",
      "Filling: a cell at the distance of the radius does not count; one with too few others "
      "around it to have a smooth height does not count in the second round.",
      "A cell without neighbours along an axis is level along it.",
      "A scan without points votes on nothing, and no terrain begins and no voxels are chosen "
      "anew below it.",
      "sound begins the terrain at the cells nearest to a sensor that has none below it, up to "
      "12.4 m away, where the innermost zone of Patchwork++ ends: else a sensor that stands has "
      "no terrain. Where all ground within that distance is too steep, slopes count from its "
      "median "
      "slope, so that a hill has a terrain.",
      "sound has pixels that are as large as it takes for the window around a voxel to reach from "
      "one beam to the next, and asks for fewer points in a bin where the sensor's directions are "
      "farther apart than those of the HDL-64E.",
      "Filling: however far a cell deviates, it counts at least exp(-60).",
      "sound has images a pixel larger on each side than the sensor's field of view.",
      "sound tells the sensor's height by the median of the upright planes that its first scan "
      "with ground has in the innermost zone.",
      "Pixels of points and of voxels are found in single precision, and the terrain is filled "
      "in it, relative to a height nearby.",
  };
}

}  // namespace

MethodEntry mapcleaner_entry() {
  const Configuration sound = {{"public_height", false},        {"public_axes", false},
                               {"public_field_of_view", false}, {"public_overwrite", false},
                               {"public_steps", false},         {"remove_below", false},
                               {"start_radius", 12.4}};
  MethodEntry entry;
  entry.name = "mapcleaner";
  entry.version = "2";
  entry.sentence =
      "Terrain from the ground of all scans: what stands above it goes if more scans see through "
      "it than see it.";
  entry.source =
      "MapCleaner: Efficiently Removing Moving Objects from Point Cloud Maps in Autonomous Driving "
      "Scenarios (Remote Sensing 2022), ground by Patchwork++ (IROS 2022)";
  entry.bibtex = R"(@article{fu2022mapcleaner,
  author = {Fu, Hao and Xue, Hanzhang and Xie, Guanglei},
  title = {{MapCleaner}: Efficiently Removing Moving Objects from Point Cloud Maps in Autonomous
    Driving Scenarios},
  journal = {Remote Sensing},
  year = {2022},
  volume = {14},
  number = {18},
  pages = {4496},
  doi = {10.3390/rs14184496}
}
)";
  entry.notes = mapcleaner_notes();
  entry.variants = {
      {"published", "As the public program is set for KITTI.", false, {}},
      {"sound",
       "Without the quirks of the public program: height, axes and field of view are the sensor's.",
       false, sound},
  };
  entry.bind(mapcleaner_method::parameter_table(), mapcleaner_method::make_mapcleaner);
  return entry;
}

}  // namespace raymoval
