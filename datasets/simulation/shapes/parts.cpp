// SPDX-License-Identifier: MIT
#include "datasets/simulation/shapes/parts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "core/error.h"
#include "core/text.h"
#include "datasets/simulation/shapes/bodies.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector3d;

/// Pickets with gaps between two rails.
Mesh fence(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = size_or(spec.length_m, 4.0);
  const double height = varied(spec.height_m, 0.05, random, 1.1, 1.4);
  const Paint wood{Material::kWood, kLabelFence};
  for (double x = 0.0; x < length; x += 0.16) {
    add_box(mesh, wood, {x, 0.0, 0.06}, {x + 0.08, 0.025, height * random.between(0.97, 1.03)});
  }
  for (const double z : {0.25 * height, 0.8 * height}) {
    add_box(mesh, wood, {0.0, 0.025, z}, {length, 0.06, z + 0.07});
  }
  add_box(mesh, wood, {0.0, 0.0, -0.3}, {0.1, 0.1, height + 0.1});
  return mesh;
}

Mesh wall(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double length = size_or(spec.length_m, 5.0);
  const double height = varied(spec.height_m, 0.05, random, 0.9, 1.6);
  const Paint brick{Material::kBrick, kLabelFence};
  add_box(mesh, brick, {0.0, 0.0, -0.5}, {length, 0.24, height});
  add_box(mesh, brick, {-0.05, -0.06, -0.5}, {0.35, 0.3, height + 0.15});
  return mesh;
}

Mesh guardrail(const PartSpec& spec, Random&) {
  Mesh mesh;
  const double length = size_or(spec.length_m, 4.0);
  const Paint steel{Material::kMetal, kLabelFence};
  add_box(mesh, steel, {0.0, 0.0, 0.48}, {length, 0.04, 0.60});
  add_box(mesh, steel, {0.0, -0.03, 0.62}, {length, 0.04, 0.75});
  add_box(mesh, steel, {0.0, 0.04, -0.3}, {0.1, 0.16, 0.75});
  return mesh;
}

Mesh lamp_post(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double height = varied(spec.height_m, 0.05, random, 6.0, 8.0);
  const Paint pole{Material::kMetal, kLabelPole};
  add_tube(mesh, pole, {0, 0, -0.3}, {0, 0, height}, 0.10, 0.06, 9);
  add_tube(mesh, pole, {0, 0, height - 0.1}, {0, -1.6, height + 0.1}, 0.04, 0.04, 6);
  add_box(mesh, pole, {-0.12, -2.0, height}, {0.12, -1.4, height + 0.14});
  return mesh;
}

Mesh sign(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double height = varied(spec.height_m, 0.05, random, 2.3, 2.8);
  add_tube(mesh, {Material::kMetal, kLabelPole}, {0, 0, -0.3}, {0, 0, height}, 0.035, 0.035, 7);
  add_tube(mesh, {Material::kSign, kLabelTrafficSign}, {-0.04, 0, height - 0.3},
           {-0.055, 0, height - 0.3}, 0.32, 0.32, 14);
  return mesh;
}

Mesh traffic_light(const PartSpec&, Random&) {
  Mesh mesh;
  const Paint pole{Material::kMetal, kLabelPole};
  add_tube(mesh, pole, {0, 0, -0.3}, {0, 0, 3.4}, 0.06, 0.06, 8);
  add_box(mesh, {Material::kDarkPaint, kLabelTrafficSign}, {-0.28, -0.14, 2.4}, {-0.06, 0.14, 3.3});
  return mesh;
}

Mesh bin(const PartSpec&, Random& random) {
  Mesh mesh;
  const Paint paint{Material::kCloth, kLabelOtherObject};
  for (int i = 0; i < 2 + random.below(2); ++i) {
    const double x = 0.75 * i;
    add_frustum(mesh, paint, paint,
                {Vector3d(x, -0.3, 0), Vector3d(x + 0.5, -0.3, 0), Vector3d(x + 0.5, 0.25, 0),
                 Vector3d(x, 0.25, 0)},
                {Vector3d(x - 0.04, -0.35, 1.05), Vector3d(x + 0.55, -0.35, 1.05),
                 Vector3d(x + 0.55, 0.35, 1.1), Vector3d(x - 0.04, 0.35, 1.1)});
  }
  return mesh;
}

/// Two to four bicycles side by side, across the row.
Mesh bicycles(const PartSpec&, Random& random) {
  Mesh mesh;
  Mesh bicycle;
  add_bicycle(bicycle);
  for (Paint& paint : bicycle.paints) paint.label = kLabelBicycle;
  const int count = 2 + random.below(3);
  for (int i = 0; i < count; ++i) {
    mesh.append(bicycle, placed(0.55 * i, 0.0, 0.0, 1.5708 + 0.15 * random.normal()));
  }
  return mesh;
}

Mesh bollard(const PartSpec&, Random&) {
  Mesh mesh;
  add_tube(mesh, {Material::kMetal, kLabelPole}, {0, 0, -0.2}, {0, 0, 0.9}, 0.06, 0.05, 8);
  return mesh;
}

Mesh container(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double l = varied(spec.length_m, 0.05, random, 5.8, 6.2);
  const Paint paint{Material::kBrightPaint, kLabelOtherStructure};
  add_box(mesh, paint, {-0.5 * l, 0, -0.1}, {0.5 * l, 2.44, 2.6});
  for (double x = -0.5 * l + 0.2; x < 0.5 * l - 0.2; x += 0.4) {  // ribs
    add_box(mesh, paint, {x, -0.04, 0.1}, {x + 0.15, 2.48, 2.5});
  }
  return mesh;
}

/// A spoil heap: a rough cone.
Mesh heap(const PartSpec& spec, Random& random) {
  Mesh mesh;
  const double radius = 0.5 * varied(spec.width_m, 0.05, random, 5.0, 9.0);
  const double height = varied(spec.height_m, 0.05, random, 1.6, 2.8);
  constexpr int kRings = 7;
  constexpr int kSides = 22;
  const Paint soil{Material::kSoil, kLabelTerrain};
  const auto top = mesh.vertex({0, 0, height * random.between(0.92, 1.0)});
  for (int r = 1; r <= kRings; ++r) {
    for (int s = 0; s < kSides; ++s) {
      const double share = static_cast<double>(r) / kRings;
      const double angle = 6.28318530717958648 * s / kSides;
      const double out = radius * share * random.between(0.93, 1.07);
      const double z = height * (1.0 - share) * (1.0 + 0.3 * share) + 0.07 * random.normal();
      mesh.vertex({out * std::cos(angle), out * std::sin(angle), r == kRings ? -0.4 : z});
    }
  }
  const auto at = [&](int r, int s) {
    return top + 1 + static_cast<std::uint32_t>((r - 1) * kSides + s % kSides);
  };
  for (int s = 0; s < kSides; ++s) {
    mesh.triangle(top, at(1, s), at(1, s + 1), soil);
    for (int r = 1; r < kRings; ++r) {
      mesh.triangle(at(r, s), at(r + 1, s), at(r, s + 1), soil);
      mesh.triangle(at(r, s + 1), at(r + 1, s), at(r + 1, s + 1), soil);
    }
  }
  return mesh;
}

/// A road bridge across the row's road: a deck over it on two walls. Origin in the road's middle.
Mesh bridge(const PartSpec& spec, Random&) {
  Mesh mesh;
  const double span = size_or(spec.width_m, 30.0);
  const double depth = size_or(spec.length_m, 9.0);
  const double height = size_or(spec.height_m, 5.2);
  const Paint concrete{Material::kConcrete, kLabelOtherStructure};
  const double h = 0.5 * span;
  const double d = 0.5 * depth;
  add_box(mesh, concrete, {-d, -h, height}, {d, h, height + 1.1});
  for (const double side : {-1.0, 1.0}) {
    add_box(mesh, concrete, {-d, side * h - 0.5, -0.5}, {d, side * h + 0.5, height});
    add_box(mesh, concrete, {side * d - 0.1, -h, height + 1.1}, {side * d + 0.1, h, height + 2.0});
  }
  return mesh;
}

Mesh parked(const std::string& kind, std::uint16_t instance, Random& random) {
  const Body body = make_body(kind, random);
  const Mesh standing =
      resting_mesh(body, (static_cast<std::uint32_t>(instance) << 16) | body.static_label);
  Mesh mesh;
  mesh.append(standing, placed(0, 0, 0, random.chance(0.5) ? 0.0 : 3.14159265358979));
  return mesh;
}

using Maker = std::function<Mesh(const PartSpec&, std::uint16_t, Random&)>;

const std::vector<std::pair<std::string, Maker>>& makers() {
  const auto plain = [](Mesh (*make)(const PartSpec&, Random&)) {
    return
        [make](const PartSpec& spec, std::uint16_t, Random& random) { return make(spec, random); };
  };
  const auto vehicle = [](const std::string& kind) {
    return [kind](const PartSpec&, std::uint16_t instance, Random& random) {
      return parked(kind, instance, random);
    };
  };
  static const std::vector<std::pair<std::string, Maker>> table = {
      {"block", plain(make_block)},
      {"house", plain(make_house)},
      {"garage", plain(make_garage)},
      {"fence", plain(fence)},
      {"wall", plain(wall)},
      {"guardrail", plain(guardrail)},
      {"hedge", plain(make_hedge)},
      {"tree", plain(make_tree)},
      {"conifer", plain(make_conifer)},
      {"bush", plain(make_bush)},
      {"tall_grass", plain(make_tall_grass)},
      {"lamp_post", plain(lamp_post)},
      {"sign", plain(sign)},
      {"traffic_light", plain(traffic_light)},
      {"bin", plain(bin)},
      {"bicycles", plain(bicycles)},
      {"bollard", plain(bollard)},
      {"container", plain(container)},
      {"heap", plain(heap)},
      {"bridge", plain(bridge)},
      {"stall", plain(make_stall)},
      {"rack", plain(make_rack)},
      {"pillar", plain(make_pillar)},
      {"ceiling", plain(make_ceiling)},
      {"ramp", plain(make_ramp)},
      {"parked_car", vehicle("car")},
      {"parked_van", vehicle("van")},
      {"parked_truck", vehicle("truck")},
  };
  return table;
}

}  // namespace

const std::vector<std::string>& part_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& [name, maker] : makers()) list.push_back(name);
    return list;
  }();
  return names;
}

Mesh make_part(const PartSpec& spec, std::uint16_t instance, Random& random) {
  for (const auto& [name, maker] : makers()) {
    if (name != spec.part) continue;
    Mesh mesh = maker(spec, instance, random);
    for (Paint& paint : mesh.paints) {
      paint.label = (static_cast<std::uint32_t>(instance) << 16) | (paint.label & 0xFFFFU);
    }
    return mesh;
  }
  throw ConfigurationError("unknown part '" + spec.part + "'." +
                           suggestion(spec.part, part_names()));
}

bool has_instance(const std::string& part) {
  static const std::set<std::string> objects = {"lamp_post", "sign",    "traffic_light", "bin",
                                                "bicycles",  "bollard", "container"};
  return part.starts_with("parked") || objects.count(part) != 0;
}

bool is_continuous(const std::string& part) {
  return part == "fence" || part == "wall" || part == "guardrail" || part == "hedge";
}

double footprint_radius(const PartSpec& spec) {
  if (spec.part == "block") return 0.5 * (spec.length_m > 0 ? spec.length_m : 16.0) + 1.0;
  if (spec.part == "house") return 0.5 * (spec.length_m > 0 ? spec.length_m : 12.0) + 1.0;
  if (is_continuous(spec.part)) return 0.5 * std::max(spec.length_m, 2.0) + 1.5;
  if (spec.part == "bridge" || spec.part == "ceiling") return -1000.0;
  if (spec.part == "parked_car" || spec.part == "parked_van") return 6.0;
  if (spec.part == "parked_truck" || spec.part == "garage") return 7.0;
  return 0.5;
}

}  // namespace raymoval::simulated
