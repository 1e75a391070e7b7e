// SPDX-License-Identifier: MIT
#include "methods/dufomap/dufomap.h"

namespace raymoval {

MethodEntry dufomap_entry() {
  const Configuration wide = {{"unknown_inflation", std::int64_t{2}}};
  const Configuration as_online = {{"offline", false}};
  Configuration wide_online = as_online;
  wide_online.insert(wide_online.end(), wide.begin(), wide.end());
  MethodEntry entry;
  entry.name = "dufomap";
  entry.sentence =
      "Void voxels: what one scan once saw certainly free, with all its neighbours, holds only "
      "moving objects, before and after.";
  entry.source = "DUFOMap: Efficient Dynamic Awareness Mapping (RA-L 2024)";
  entry.notes = {
      "The default is the public configuration (d_p 1), which reproduces the paper's table; the "
      "public Python example passes d_p 2, here the variants called dp2.",
      "One beam per occupied voxel, to the voxel's centre ('center' sampling); the other samplings "
      "of the public code are left out.",
      "Points nearer than minimum_range cast no beam at all; the public code leaves out their hits "
      "only, measured to the voxel's centre. They are answered for like all others.",
      "Beams are followed in fixed point of 40 binary places and poses stay in double precision; "
      "the public code sums up single precision.",
      "A beam that passes exactly through an edge crosses x before y before z.",
      "The extent is that of the common lattice instead of 20 octree levels, and a beam may be "
      "131,072 voxels long.",
      "The public code's optional clustering of voids, off there, is left out.",
  };
  entry.variants = {
      {"offline", "Every point answered after the last scan.", false, {}},
      {"online", "Each scan answered once it is integrated.", true, as_online},
      {"offline-dp2", "Offline with d_p 2.", false, wide},
      {"online-dp2", "Online with d_p 2.", true, wide_online},
  };
  entry.bind(dufomap_method::parameter_table(), dufomap_method::make_dufomap);
  return entry;
}

}  // namespace raymoval
