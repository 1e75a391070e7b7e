// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/simulation/shapes/parts.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector3d;

constexpr Paint kLeaves{Material::kLeaf, kLabelVegetation};
constexpr Paint kBark{Material::kWood, kLabelTrunk};

/// A branch from the stem to `tip` with leaves around its outer half.
void add_branch(Mesh& mesh, const Vector3d& from, const Vector3d& tip, int leaves, Random& random) {
  add_tube(mesh, kLeaves, from, tip, 0.06, 0.02, 5);
  for (int i = 0; i < leaves; ++i) {
    const double share = random.between(0.45, 1.05);
    const Vector3d off = random.normals();
    add_leaf(mesh, kLeaves, from + share * (tip - from) + 0.3 * off, 0.28, random);
  }
}

}  // namespace

Mesh make_tree(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double height = varied(spec.height_m, 0.15, random, 6.0, 10.0);
  const double radius = 0.5 * varied(spec.width_m, 0.15, random, 4.0, 6.5);
  const double fork = height * random.between(0.28, 0.36);
  const double girth = 0.018 * height + 0.04;
  const double lean_y = 0.04 * random.normal(), lean_x = 0.04 * random.normal();
  const Vector3d lean(lean_x, lean_y, 1.0);
  add_tube(mesh, kBark, {0, 0, -0.4}, fork * lean, girth, 0.75 * girth, 8);
  add_tube(mesh, kBark, fork * lean, 0.8 * height * lean, 0.7 * girth, 0.25 * girth, 6);
  const double middle = 0.5 * (fork + height);
  const Vector3d crown = middle * lean;
  const Vector3d radii(radius, radius, 0.5 * (height - fork) + 0.3);
  const int count = static_cast<int>(34.0 * radius * radius);
  add_leaves(mesh, kLeaves, crown, radii, 0.34, count, random);
  for (int i = 0; i < 6; ++i) {
    const double angle = 6.28318530717958648 * (i + random.between(-0.3, 0.3)) / 6.0;
    const Vector3d out(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    add_branch(mesh, (fork + 0.1 * i) * lean, crown + 0.9 * out, 10, random);
  }
  const double reach = radius * random.between(1.1, 1.5);
  add_branch(mesh, fork * lean, Vector3d(0.4 * radius, -reach, fork + 0.8), 26, random);
  return mesh;
}

Mesh make_conifer(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double height = varied(spec.height_m, 0.15, random, 8.0, 14.0);
  const double radius = 0.5 * varied(spec.width_m, 0.15, random, 3.0, 4.5);
  add_tube(mesh, kBark, {0, 0, -0.4}, {0, 0, height}, 0.2, 0.03, 7);
  const int count = static_cast<int>(55.0 * radius * height / 4.0);
  for (int i = 0; i < count; ++i) {
    const double up = std::sqrt(random.unit());  // more leaves where the cone is wide
    const double z = height - up * (height - 0.7);
    const double out = radius * up * std::sqrt(random.between(0.3, 1.0));
    const double angle = random.between(0.0, 6.28318530717958648);
    add_leaf(mesh, kLeaves, {out * std::cos(angle), out * std::sin(angle), z}, 0.35, random);
  }
  return mesh;
}

Mesh make_hedge(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = size_or(spec.length_m, 4.0);
  const double width = size_or(spec.width_m, 0.9);
  const double height = varied(spec.height_m, 0.15, random, 1.1, 1.7);
  add_box(mesh, kLeaves, {0.0, 0.3 * width, -0.3}, {length, 0.7 * width, 0.8 * height});
  const int count = static_cast<int>(length * height * 55.0);
  for (int i = 0; i < count; ++i) {
    const Vector3d at = random.within(Vector3d::Zero(), {length, width, height});
    add_leaf(mesh, kLeaves, at, 0.14, random);
  }
  return mesh;
}

Mesh make_bush(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double radius = 0.5 * varied(spec.width_m, 0.15, random, 1.2, 2.6);
  const double height = varied(spec.height_m, 0.15, random, 0.9, 2.0);
  const int count = static_cast<int>(70.0 * radius * height);
  add_leaves(mesh, kLeaves, {0, 0, 0.5 * height}, {radius, radius, 0.55 * height}, 0.2, count,
             random);
  return mesh;
}

Mesh make_tall_grass(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = size_or(spec.length_m, 4.0);
  const double width = size_or(spec.width_m, 2.0);
  const double height = size_or(spec.height_m, 0.4);
  const int count = static_cast<int>(length * width * 9.0);
  for (int i = 0; i < count; ++i) {
    const double z = height * random.unit() * random.unit();
    add_leaf(mesh, kLeaves, {random.between(0, length), random.between(0, width), z}, 0.12, random);
  }
  return mesh;
}

}  // namespace raymoval::simulated
