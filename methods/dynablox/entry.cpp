// SPDX-License-Identifier: MIT
#include "methods/dynablox/dynablox.h"

namespace raymoval {

MethodEntry dynablox_entry() {
  const Configuration mistakes = {{"public_boxes", true},
                                  {"public_merges", true},
                                  {"public_unmapped", true},
                                  {"public_reset", true}};
  const Configuration header = {{"free_neighbours", std::string("edges")},
                                {"frames_to_reset", std::int64_t{50}},
                                {"grow_twice", true},
                                {"min_points", std::int64_t{25}},
                                {"max_points", std::int64_t{2500}},
                                {"min_extent", 0.25},
                                {"max_extent", 2.5}};
  const Configuration wide = {{"max_range", 80.0}};
  const Configuration offline = {{"offline", true}};
  Configuration offline_wide = wide;
  offline_wide.emplace_back("offline", true);
  MethodEntry entry;
  entry.name = "dynablox";
  entry.version = "2";
  entry.sentence =
      "A distance field finds voxels that were once free for sure; what appears there moves.";
  entry.source = "Dynablox: Real-time Detection of Diverse Dynamic Objects (RA-L 2023)";
  entry.notes = {
      "The default is as published and without the public program's mistakes, each of which has a "
      "switch (public_...).",
      "Rows, columns and the vertical field of view of the range image are the sensor's (image).",
      "A pixel has its nearest return, but for those nearer than min_range, which are left out.",
      "Voxels are reset all at once, so that no order of voxels or blocks counts; in the public "
      "program a voxel that another one has just reset resets no more (public_reset).",
      "A voxel with points that touches two clusters makes them one, so that no order of seeds "
      "counts; centres of voxels, not points, are compared when clusters are merged, as the "
      "shipped configuration does.",
      "The voxels' flag 'dynamic' is left out: nothing reads it.",
  };
  entry.variants = {
      {"published", "As the public program is configured, without its mistakes.", true, {}},
      {"public-code", "With the mistakes of the public program.", true, mistakes},
      {"header", "With the defaults of the public program's source.", true, header},
      {"wide", "Up to 80 m instead of 20.", true, wide},
      {"offline", "A point goes if its voxel is ever free in the end.", false, offline},
      {"offline-wide", "Both.", false, offline_wide},
  };
  entry.bind(dynablox_method::parameter_table(), dynablox_method::make_dynablox);
  return entry;
}

}  // namespace raymoval
