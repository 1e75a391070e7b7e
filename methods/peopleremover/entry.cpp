// SPDX-License-Identifier: MIT
#include "methods/peopleremover/peopleremover.h"

namespace raymoval {
namespace peopleremover_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kConstant = "a constant in 3DTK";

Table make_table() {
  return Table()
      .number("voxel_size", &P::voxel_size,
              {"m", 0.02, 10, "--voxel-size; 3DTK: 10 of its units, 0.1 m in centimetre data",
               "Edge of a voxel."})
      .choice("maxrange_method", &P::maxrange_method,
              {{"none", MaxrangeMethod::kNone}, {"normals", MaxrangeMethod::kNormals}},
              {.source = "--maxrange-method; 3DTK: none",
               .sentence = "Beams go to their point, or end one voxel diagonal in front of the "
                           "plane of the surface around it (point shadows)."})
      .integer("diff", &P::diff,
               {"scans", 0, 100000, "--diff",
                "A voxel with points of a scan whose number differs by at most this from the "
                "beam's scan is not freed and stops the beam."})
      .integer("min_cluster_size", &P::min_cluster_size,
               {"voxels", 0, 1e9, "--min-cluster-size",
                "Smaller 26-connected clusters of freed voxels are discarded; 1 or less keeps all "
                "clusters."})
      .flag("subvoxel_accuracy", &P::subvoxel_accuracy,
            {.source = "--no-subvoxel-accuracy",
             .sentence =
                 "Also remove points near a freed voxel, of the scans that have points in it."})
      .integer("half_voxel_radius", &P::half_voxel_radius,
               {"voxels", 1, 8, kConstant, "Distance for subvoxel_accuracy.",
                "subvoxel_accuracy is true"})
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 100, kConstant,
               "Points nearer to the sensor than this are left out and kept; 0 is the voxel "
               "diagonal, as in 3DTK."});
}

}  // namespace
}  // namespace peopleremover_method

MethodEntry peopleremover_entry() {
  const std::string none = "none";
  MethodEntry entry;
  entry.name = "peopleremover";
  entry.sentence =
      "Frees every voxel that a beam passes before the surface that its scan measures, and removes "
      "the points in free voxels.";
  entry.source =
      "Schauer and Nuechter: The Peopleremover - Removing Dynamic Objects From 3-D Point Cloud "
      "Data by Traversing a Voxel Occupancy Grid, RA-L 2018";
  entry.bibtex = R"(@article{schauer2018peopleremover,
  author = {Schauer, Johannes and N{\"u}chter, Andreas},
  title = {The Peopleremover---Removing Dynamic Objects From 3-D Point Cloud Data by Traversing a
    Voxel Occupancy Grid},
  journal = {IEEE Robotics and Automation Letters},
  year = {2018},
  volume = {3},
  number = {3},
  pages = {1679--1686},
  doi = {10.1109/LRA.2018.2801797}
}
)";
  entry.notes = {
      // The page of the method has all notes.
      "maxrange_method = none follows whole beams, as 3DTK did before May 2020; its present "
      "version follows none there and removes nothing.",
      "maxrange_method = normals is the default here and the choice of 3DTK's own example; 3DTK's "
      "default is none.",
      "Points within the minimum range, which 3DTK drops, are static.",
      "A point within two voxel diagonals of the sensor has no beam; 3DTK takes the arc sine of a "
      "value above 1 there.",
      "The normal is towards the sensor where fewer than three points, or points on a line, would "
      "decide it; no beam passes its own point.",
      "--fuzz and --reduce, normal-method (only angle works), normal-knearest (without effect), "
      "and the values of maxrange-method that abort in 3DTK are left out.",
  };
  entry.variants = {
      {.name = "normals",
       .sentence = "Point shadows, voxels of 0.2 m: what its authors recommend."},
      {.name = "fine",
       .sentence = "Point shadows, voxels of 0.1 m: 3DTK's default size.",
       .overrides = {{"voxel_size", 0.1}}},
      {.name = "none",
       .sentence =
           "Whole beams, voxels of 0.2 m: nothing protects surfaces seen at a grazing angle.",
       .overrides = {{"maxrange_method", none}}},
      {.name = "plain",
       .sentence =
           "Whole beams, voxels of 0.2 m, freed voxels only: closest to the published rows.",
       .overrides = {{"maxrange_method", none}, {"subvoxel_accuracy", false}}},
  };
  entry.bind(peopleremover_method::make_table(), peopleremover_method::make_peopleremover);
  return entry;
}

}  // namespace raymoval
