// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/mapcleaner.h"

namespace raymoval {
namespace {

std::vector<std::string> notes() {
  return {
      "The default is the public program set for KITTI, whose ground segmentation is Patchwork++ "
      "instead of the paper's; its quirks have switches (public_...).",
      "Dynamic is what is voted dynamic. The public program saves what lies below the terrain "
      "nowhere, so that it goes (remove_below); what has no terrain it saves in a file of its own "
      "as neither static nor dynamic, so that it stays (remove_other).",
  };
}

}  // namespace

MethodEntry mapcleaner_entry() {
  const Configuration sound = {{"public_height", false}, {"public_axes", false},
                               {"public_image", false},  {"public_overwrite", false},
                               {"remove_below", false},  {"start_radius", 12.4}};
  MethodEntry entry;
  entry.name = "mapcleaner";
  entry.sentence =
      "Terrain from the ground of all scans: what stands above it goes if more scans see through "
      "it than see it.";
  entry.source =
      "MapCleaner: Efficiently Removing Moving Objects from Point Cloud Maps in Autonomous Driving "
      "Scenarios (Remote Sensing 2022), ground by Patchwork++ (IROS 2022)";
  entry.notes = notes();
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
