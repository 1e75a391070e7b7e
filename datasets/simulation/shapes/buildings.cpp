// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "datasets/simulation/shapes/parts.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector3d;

/// The openings of a front: storeys times columns of windows, set back `recess` into the wall.
struct Front {
  double x0, x1, y, base, storey;
  int storeys, columns;
  double recess;
  bool gateway;  ///< One column of the ground floor is an open gateway, two metres deep.
};

/// Face of a wall with recessed panes: for each bay, the wall around a hole, its reveals, a pane.
void add_bay(Mesh& mesh, Paint wall, const Front& f, double x0, double x1, double z0, bool gate) {
  const double z1 = z0 + f.storey;
  const double margin = gate ? 0.15 * (x1 - x0) : 0.27 * (x1 - x0);
  const double a = x0 + margin;
  const double b = x1 - margin;
  const double sill = gate ? z0 - 0.3 : z0 + 0.3 * f.storey;
  const double lintel = z0 + 0.82 * f.storey;
  const double in = f.y + (gate ? 2.0 : f.recess);
  const auto at = [](double x, double y, double z) { return Vector3d(x, y, z); };
  const double foot = gate ? z0 - 0.3 : z0;
  add_quad(mesh, wall, at(x0, f.y, foot), at(a, f.y, foot), at(a, f.y, z1), at(x0, f.y, z1));
  add_quad(mesh, wall, at(b, f.y, foot), at(x1, f.y, foot), at(x1, f.y, z1), at(b, f.y, z1));
  add_quad(mesh, wall, at(a, f.y, lintel), at(b, f.y, lintel), at(b, f.y, z1), at(a, f.y, z1));
  if (!gate) {
    add_quad(mesh, wall, at(a, f.y, z0), at(b, f.y, z0), at(b, f.y, sill), at(a, f.y, sill));
  }
  add_quad(mesh, wall, at(a, f.y, sill), at(a, in, sill), at(a, in, lintel), at(a, f.y, lintel));
  add_quad(mesh, wall, at(b, f.y, sill), at(b, in, sill), at(b, in, lintel), at(b, f.y, lintel));
  add_quad(mesh, wall, at(a, f.y, lintel), at(b, f.y, lintel), at(b, in, lintel),
           at(a, in, lintel));
  if (!gate)
    add_quad(mesh, wall, at(a, f.y, sill), at(b, f.y, sill), at(b, in, sill), at(a, in, sill));
  const Paint pane{gate ? Material::kWood : Material::kGlass, kLabelBuilding};
  add_quad(mesh, pane, at(a, in, sill), at(b, in, sill), at(b, in, lintel), at(a, in, lintel));
}

void add_front(Mesh& mesh, Paint wall, const Front& f, int gate_column) {
  const double bay = (f.x1 - f.x0) / f.columns;
  for (int storey = 0; storey < f.storeys; ++storey) {
    for (int column = 0; column < f.columns; ++column) {
      const bool gate = f.gateway && storey == 0 && column == gate_column;
      add_bay(mesh, wall, f, f.x0 + column * bay, f.x0 + (column + 1) * bay,
              f.base + storey * f.storey, gate);
    }
  }
}

/// The other three walls, the plinth below the front, and a roof with its ridge along x.
void add_hull(Mesh& mesh, Paint wall, const Front& f, double depth, double ridge) {
  const double top = f.base + f.storeys * f.storey;
  const double back = f.y + depth;
  const Paint roof{Material::kRoof, kLabelBuilding};
  const double middle = 0.5 * (f.y + back);
  const auto at = [](double x, double y, double z) { return Vector3d(x, y, z); };
  for (const double x : {f.x0, f.x1}) {
    add_quad(mesh, wall, at(x, f.y, -1), at(x, back, -1), at(x, back, top), at(x, f.y, top));
    add_quad(mesh, wall, at(x, f.y, top), at(x, back, top), at(x, middle, top + ridge),
             at(x, middle, top + ridge));
  }
  add_quad(mesh, wall, at(f.x0, back, -1), at(f.x1, back, -1), at(f.x1, back, top),
           at(f.x0, back, top));
  const double eaves = 0.35;
  const double drop = ridge * eaves / (middle - f.y);
  add_quad(mesh, roof, at(f.x0, f.y - eaves, top - drop), at(f.x1, f.y - eaves, top - drop),
           at(f.x1, middle, top + ridge), at(f.x0, middle, top + ridge));
  add_quad(mesh, roof, at(f.x0, back + eaves, top - drop), at(f.x1, back + eaves, top - drop),
           at(f.x1, middle, top + ridge), at(f.x0, middle, top + ridge));
}

void add_chimney(Mesh& mesh, Paint wall, double x, double y, double z) {
  add_box(mesh, wall, {x - 0.3, y - 0.3, z - 2.0}, {x + 0.3, y + 0.3, z + 0.8});
}

void add_balcony(Mesh& mesh, double x, double y, double z) {
  const Paint concrete{Material::kConcrete, kLabelBuilding};
  const Paint steel{Material::kMetal, kLabelBuilding};
  add_box(mesh, concrete, {x - 1.3, y - 1.1, z}, {x + 1.3, y, z + 0.15});
  for (double at = x - 1.3; at <= x + 1.3; at += 0.13) {
    add_box(mesh, steel, {at, y - 1.1, z + 0.15}, {at + 0.02, y - 1.08, z + 1.05});
  }
  add_box(mesh, steel, {x - 1.3, y - 1.12, z + 1.05}, {x + 1.3, y - 1.06, z + 1.1});
}

}  // namespace

Mesh make_block(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = varied(spec.length_m, 0.04, random, 11.0, 18.0);
  const double depth = varied(spec.width_m, 0.04, random, 9.0, 12.0);
  const Paint wall{random.chance(0.6) ? Material::kPlaster : Material::kBrick, kLabelBuilding};
  Front f;
  f.x0 = -0.5 * length;
  f.x1 = 0.5 * length;
  f.y = random.between(0.0, 0.4);
  f.base = random.between(0.0, 0.3);
  f.storey = random.between(2.9, 3.3);
  f.storeys =
      std::max(1, static_cast<int>(std::lround((spec.height_m > 0 ? spec.height_m : 10.0) / 3.1)) +
                      random.below(2));
  f.columns = std::max(2, static_cast<int>(length / random.between(2.3, 3.0)));
  f.recess = random.between(0.12, 0.3);
  f.gateway = true;
  add_front(mesh, wall, f, random.below(f.columns));
  add_quad(mesh, wall, {f.x0, f.y, -1}, {f.x1, f.y, -1}, {f.x1, f.y, f.base}, {f.x0, f.y, f.base});
  add_hull(mesh, wall, f, depth, random.between(1.5, 3.5));
  if (f.storeys > 1 && random.chance(0.6)) {
    add_balcony(mesh, random.between(f.x0 + 2, f.x1 - 2), f.y, f.base + f.storey);
  }
  return mesh;
}

Mesh make_house(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = varied(spec.length_m, 0.04, random, 9.0, 13.0);
  const double depth = varied(spec.width_m, 0.04, random, 8.0, 10.0);
  const Paint wall{random.chance(0.7) ? Material::kPlaster : Material::kBrick, kLabelBuilding};
  Front f{-0.5 * length,
          0.5 * length,
          random.between(0.0, 1.5),
          0.2,
          2.8,
          spec.height_m > 5.0 ? 2 : 1 + random.below(2),
          4,
          0.15,
          false};
  add_front(mesh, wall, f, 0);
  add_quad(mesh, wall, {f.x0, f.y, -1}, {f.x1, f.y, -1}, {f.x1, f.y, f.base}, {f.x0, f.y, f.base});
  const double ridge = random.between(2.5, 4.0);
  add_hull(mesh, wall, f, depth, ridge);
  add_chimney(mesh, wall, 0.2 * length, f.y + 0.4 * depth, f.base + f.storeys * f.storey + ridge);
  const double porch = random.between(f.x0 + 2.0, f.x1 - 2.0);
  add_box(mesh, {Material::kRoof, kLabelBuilding}, {porch - 1.1, f.y - 1.3, 2.4},
          {porch + 1.1, f.y, 2.5});
  for (const double side : {-1.0, 1.0}) {
    add_tube(mesh, {Material::kWood, kLabelBuilding}, {porch + side, f.y - 1.2, -0.3},
             {porch + side, f.y - 1.2, 2.4}, 0.06, 0.06, 6);
  }
  add_box(mesh, {Material::kConcrete, kLabelBuilding}, {porch - 0.9, f.y - 1.0, -0.3},
          {porch + 0.9, f.y, 0.17});
  return mesh;
}

Mesh make_garage(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = varied(spec.length_m, 0.04, random, 3.2, 6.2);
  const Paint wall{Material::kPlaster, kLabelBuilding};
  const double h = 0.5 * length;
  add_box(mesh, wall, {-h, 0.0, -0.5}, {-h + 0.3, 6.0, 2.5});
  add_box(mesh, wall, {h - 0.3, 0.0, -0.5}, {h, 6.0, 2.5});
  add_box(mesh, wall, {-h, 0.0, 2.15}, {h, 6.0, 2.6});
  add_box(mesh, {Material::kMetal, kLabelBuilding}, {-h + 0.3, 0.25, -0.5}, {h - 0.3, 0.3, 2.15});
  add_box(mesh, wall, {-h, 5.7, -0.5}, {h, 6.0, 2.5});
  return mesh;
}

}  // namespace raymoval::simulated
