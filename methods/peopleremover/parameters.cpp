// SPDX-License-Identifier: MIT
#include "methods/peopleremover/parameters.h"

#include <cmath>

namespace raymoval::peopleremover_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kConstant = "a constant in 3DTK";

Table make_table() {
  Table table;
  table
      .number("voxel_size", &P::voxel_size,
              {"m", 0.02, 10, "--voxel-size; 3DTK: 10 of its units, 0.1 m in centimetre data",
               "Edge of a voxel."})
      .choice("maxrange_method", &P::maxrange_method,
              {{"none", MaxrangeMethod::kNone}, {"normals", MaxrangeMethod::kNormals}},
              {.source = "--maxrange-method; 3DTK: none",
               .sentence = "Beams go to their point, or end one voxel diagonal in front of the "
                           "plane of the surface around it (point shadows)."})
      .number("fuzz", &P::fuzz,
              {"m", 0, 10, "--fuzz", "Beams end so much farther in front of the surface.",
               "maxrange_method is normals"})
      .integer("diff", &P::diff,
               {"scans", 0, 100000, "--diff",
                "A voxel with points of a scan within so many of the beam's is not freed and stops "
                "the beam."})
      .integer("min_cluster_size", &P::min_cluster_size,
               {"voxels", 0, 1e9, "--min-cluster-size",
                "Smaller 26-connected clusters of freed voxels are discarded; 1 or less keeps "
                "all."})
      .flag("subvoxel_accuracy", &P::subvoxel_accuracy,
            {.source = "--no-subvoxel-accuracy",
             .sentence = "Remove, near a freed voxel, also the points of the scans that have "
                         "points in it."})
      .integer("half_voxel_radius", &P::half_voxel_radius,
               {"voxels", 1, 8, kConstant, "How near is near for subvoxel_accuracy.",
                "subvoxel_accuracy is true"})
      .number("minimum_range", &P::minimum_range,
              {"m", 0, 100, kConstant,
               "Points this near are left out and stay static; 0 takes the voxel diagonal, as "
               "3DTK does."})
      .integer("reduce_points", &P::reduce_points,
               {"points", 0, 1e9, "--reduce X:Y, X",
                "Follow at most so many beams per cell of directions, chosen at random; 0 follows "
                "all."})
      .number("reduce_angle", &P::reduce_angle,
              {"rad", 1e-4, 3.1415, "--reduce X:Y, Y",
               "Such a cell has the solid angle of a cap of this half-angle.", "reduce_points > 0"})
      .integer("reduce_seed", &P::reduce_seed,
               {"", 0, 1e9, "a constant in 3DTK", "Another seed chooses other beams.",
                "reduce_points > 0"});
  return table;
}

}  // namespace

double Parameters::voxel_diagonal() const {
  return std::sqrt(3.0) * voxel_size;
}

double Parameters::effective_minimum_range() const {
  return minimum_range > 0.0 ? minimum_range : voxel_diagonal();
}

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace raymoval::peopleremover_method
