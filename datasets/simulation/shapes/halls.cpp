// SPDX-License-Identifier: MIT
// Objects in halls and on markets.
#include "datasets/simulation/shapes/parts.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector3d;

}  // namespace

Mesh make_stall(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double half = 0.5 * size_or(spec.length_m, 3.0);
  const double depth = size_or(spec.width_m, 2.0);
  const double height = size_or(spec.height_m, 2.2) * random.between(0.97, 1.03);
  const Paint wood{Material::kWood, kLabelOtherStructure};
  const Paint cloth{Material::kCloth, kLabelOtherStructure};
  for (const double x : {-half, half}) {
    for (const double y : {0.0, depth}) {
      add_tube(mesh, wood, {x, y, -0.2}, {x, y, height}, 0.03, 0.03, 6);
    }
  }
  // An awning that hangs lower over the counter.
  add_quad(mesh, cloth, {-half - 0.2, -0.5, height - 0.25}, {half + 0.2, -0.5, height - 0.25},
           {half + 0.2, depth + 0.1, height + 0.15}, {-half - 0.2, depth + 0.1, height + 0.15});
  add_box(mesh, wood, {-half, 0.0, 0.0}, {half, 0.75, 0.85});
  for (double x = -half + 0.3; x < half - 0.3; x += 0.55) {  // goods
    const double top = 0.85 + random.between(0.05, 0.35);
    add_box(mesh, cloth, {x - 0.22, 0.08, 0.85}, {x + 0.22, 0.6, top});
  }
  return mesh;
}

Mesh make_rack(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double half = 0.5 * size_or(spec.length_m, 2.7);
  const double depth = size_or(spec.width_m, 1.1);
  const double height = size_or(spec.height_m, 5.5);
  const Paint steel{Material::kBrightPaint, kLabelOtherStructure};
  const Paint goods{Material::kWood, kLabelOtherObject};
  for (const double x : {-half, half}) {
    for (const double y : {0.0, depth}) {
      add_box(mesh, steel, {x - 0.05, y - 0.04, 0.0}, {x + 0.05, y + 0.04, height});
    }
  }
  for (double z = 0.1; z + 1.0 < height; z += 1.7) {
    for (const double y : {0.0, depth}) {
      add_box(mesh, steel, {-half, y - 0.03, z}, {half, y + 0.03, z + 0.1});
    }
    for (const double x : {-0.5 * half, 0.5 * half}) {
      if (!random.chance(0.8)) continue;
      const double top = z + 0.1 + random.between(0.5, 1.35);
      const double wide = 0.42 * half * random.between(0.85, 1.0);
      add_box(mesh, goods, {x - wide, 0.05, z + 0.1}, {x + wide, depth - 0.05, top});
    }
  }
  return mesh;
}

Mesh make_pillar(const PartSpec& spec, Random&) {
  Mesh mesh;
  const double half = 0.5 * size_or(spec.width_m, 0.5);
  add_box(mesh, {Material::kConcrete, kLabelPole}, {-half, -half, -0.3},
          {half, half, size_or(spec.height_m, 3.0)});
  return mesh;
}

Mesh make_ceiling(const PartSpec& spec, Random&) {
  Mesh mesh;
  const double l = 0.5 * size_or(spec.length_m, 20.0);
  const double w = 0.5 * size_or(spec.width_m, 20.0);
  const double h = size_or(spec.height_m, 3.0);
  const Paint concrete{Material::kConcrete, kLabelOtherStructure};
  add_box(mesh, concrete, {-l, -w, h}, {l, w, h + 0.25});
  for (double x = -l + 2.5; x < l; x += 5.0) {  // beams
    add_box(mesh, concrete, {x - 0.15, -w, h - 0.35}, {x + 0.15, w, h});
  }
  return mesh;
}

Mesh make_ramp(const PartSpec& spec, Random&) {
  constexpr double kThick = 0.25;
  Mesh mesh;
  const double l = 0.5 * size_or(spec.length_m, 16.0);
  const double h = size_or(spec.height_m, 3.0);
  add_extrusion(mesh, {Material::kConcrete, kLabelOtherGround},
                {{-l, -kThick}, {l, h - kThick}, {l, h}, {-l, 0.0}}, size_or(spec.width_m, 4.0));
  return mesh;
}

}  // namespace raymoval::simulated
