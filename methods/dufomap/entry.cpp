// SPDX-License-Identifier: MIT
#include "methods/dufomap/dufomap.h"

namespace raymoval {
namespace dufomap_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;

Table make_table() {
  return Table()
      .number("voxel_size", &P::voxel_size,
              {"m", 0.02, 2, "v; 'resolution' of the public configuration", "Edge of a voxel."})
      .number("hit_extension", &P::hit_extension,
              {"m", 0, 5, "d_s; 'inflate_hits_dist'",
               "Every hit is extended this far back along its beam: the sensor's range noise."})
      .integer("unknown_inflation", &P::unknown_inflation,
               {"voxels", 0, 8, "d_p; 'inflate_unknown'",
                "A void voxel needs all voxels within this distance (Chebyshev) observed as free "
                "by the same scan: the pose error."})
      .flag("compensate_inflation", &P::compensate_inflation,
            {.source = "'inflate_unknown_compensation'",
             .sentence = "Beams are extended behind their end by d_p voxels along one axis, so "
                         "that the inflation does not remove free space in front of surfaces.",
             .acts_when = "unknown_inflation > 0"})
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 20, "'min_range'", "Nearer points cast no beam."})
      .number("maximum_range", &P::maximum_range,
              {"m", 0, 1000, "'max_range' (-1 there)",
               "Beams free no voxel beyond this range; 0 is no limit."})
      .flag("offline", &P::offline,
            {.source = "the paper's online variant",
             .sentence = "Answer for all points after the last scan instead of for each scan once "
                         "it is integrated."});
}

}  // namespace
}  // namespace dufomap_method

MethodEntry dufomap_entry() {
  MethodEntry entry;
  entry.name = "dufomap";
  entry.sentence =
      "A voxel is void if one scan observes it and all its neighbours as free; removes all points "
      "in void voxels, of earlier and later scans.";
  entry.source = "DUFOMap: Efficient Dynamic Awareness Mapping (RA-L 2024)";
  entry.bibtex = R"(@article{duberg2024dufomap,
  author = {Duberg, Daniel and Zhang, Qingwen and Jia, Mingkai and Jensfelt, Patric},
  title = {{DUFOMap}: Efficient Dynamic Awareness Mapping},
  journal = {IEEE Robotics and Automation Letters},
  year = {2024},
  volume = {9},
  number = {6},
  pages = {5038--5045},
  doi = {10.1109/LRA.2024.3387658}
}
)";
  entry.notes = {
      // The page of the method has all notes.
      "The default is the public configuration (d_p 1), which reproduces the paper's table; the "
      "public Python example passes d_p 2, here the variants called dp2.",
      "One beam per occupied voxel, to the voxel's centre ('center' sampling); the other "
      "samplings of the public code are left out.",
      "Points nearer than minimum_range cast no beam at all; the public code leaves out their hits "
      "only, measured to the voxel's centre. They get a verdict like all others.",
      "The public code's optional clustering of voids, and its beams through hits, both off "
      "there, are left out.",
  };
  entry.variants = {
      {.name = "offline", .sentence = "Every point answered after the last scan."},
      {.name = "online",
       .sentence = "Each scan answered once it is integrated.",
       .online = true,
       .overrides = {{"offline", false}}},
      {.name = "offline-dp2",
       .sentence = "Offline with d_p 2.",
       .overrides = {{"unknown_inflation", std::int64_t{2}}}},
      {.name = "online-dp2",
       .sentence = "Online with d_p 2.",
       .online = true,
       .overrides = {{"offline", false}, {"unknown_inflation", std::int64_t{2}}}},
  };
  entry.bind(dufomap_method::make_table(), dufomap_method::make_dufomap);
  return entry;
}

}  // namespace raymoval
