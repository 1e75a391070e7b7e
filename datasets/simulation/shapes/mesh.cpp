// SPDX-License-Identifier: MIT
#include "datasets/simulation/shapes/mesh.h"

namespace raymoval::simulated {

const MaterialProperties& properties(Material material) {
  // Order of magnitude of diffuse reflectivity at 905 nm; vegetation is bright in near infrared.
  static const std::array<MaterialProperties, 19> table = {{
      {0.20, 0.00},  // asphalt
      {0.35, 0.00},  // concrete
      {0.40, 0.00},  // grass
      {0.28, 0.00},  // soil
      {0.45, 0.00},  // plaster
      {0.30, 0.00},  // brick
      {0.20, 0.02},  // roof
      {0.15, 0.65},  // glass
      {0.45, 0.03},  // bright paint
      {0.10, 0.12},  // dark paint
      {0.06, 0.05},  // rubber
      {0.35, 0.06},  // metal
      {0.30, 0.00},  // wood
      {0.45, 0.00},  // leaf
      {0.35, 0.00},  // cloth
      {0.45, 0.00},  // skin
      {1.00, 0.00},  // sign
      {0.10, 0.98},  // polish
      {1.00, 0.00},  // perfect
  }};
  return table[static_cast<std::size_t>(material)];
}

void Mesh::append(const Mesh& other, const Eigen::Isometry3d& motion) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.reserve(vertices.size() + other.vertices.size());
  for (const Eigen::Vector3f& v : other.vertices) {
    vertices.push_back((motion * v.cast<double>()).cast<float>());
  }
  for (const auto& t : other.triangles) {
    triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  paints.insert(paints.end(), other.paints.begin(), other.paints.end());
}

}  // namespace raymoval::simulated
