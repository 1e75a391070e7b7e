// SPDX-License-Identifier: MIT
#include "datasets/simulation/shapes/bodies.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Paint random_paint(Random& random) {
  return paint_of(random.chance(0.6) ? Material::kBrightPaint : Material::kDarkPaint);
}

void add_wheel(Mesh& mesh, double x, double y, double radius, double width) {
  const double inner = y > 0 ? y - width : y + width;
  add_tube(mesh, paint_of(Material::kRubber), {x, inner, radius}, {x, y, radius}, radius, radius,
           14);
}

void add_wheels(Mesh& mesh, const std::vector<double>& axles, double half_width, double radius) {
  for (const double x : axles) {
    add_wheel(mesh, x, half_width, radius, 0.22);
    add_wheel(mesh, x, -half_width, radius, 0.22);
  }
}

/// The place of a cabin on a hull: the extents of its floor and roof from back to front.
struct Cabin {
  double floor_back, floor_front, roof_back, roof_front, floor_z, roof_z, floor_half, roof_half;
};

void add_cabin(Mesh& mesh, const Cabin& c, Paint roof) {
  add_frustum(mesh, paint_of(Material::kGlass), roof,
              {Vector3d(c.floor_back, -c.floor_half, c.floor_z),
               Vector3d(c.floor_front, -c.floor_half, c.floor_z),
               Vector3d(c.floor_front, c.floor_half, c.floor_z),
               Vector3d(c.floor_back, c.floor_half, c.floor_z)},
              {Vector3d(c.roof_back, -c.roof_half, c.roof_z),
               Vector3d(c.roof_front, -c.roof_half, c.roof_z),
               Vector3d(c.roof_front, c.roof_half, c.roof_z),
               Vector3d(c.roof_back, c.roof_half, c.roof_z)});
  // A cabin has pillars and roof edges besides its panes.
  for (const double side : {-1.0, 1.0}) {
    const auto bar = [&](double x0, double z0, double x1, double z1, double half0, double half1) {
      add_tube(mesh, roof, {x0, side * half0, z0}, {x1, side * half1, z1}, 0.05, 0.05, 5);
    };
    bar(c.floor_back, c.floor_z, c.roof_back, c.roof_z, c.floor_half, c.roof_half);
    bar(c.floor_front, c.floor_z, c.roof_front, c.roof_z, c.floor_half, c.roof_half);
    bar(c.roof_back, c.roof_z, c.roof_front, c.roof_z, c.roof_half, c.roof_half);
    const double middle = 0.5 * (c.roof_back + c.roof_front);
    bar(middle, c.floor_z, middle, c.roof_z, c.floor_half, c.roof_half);
  }
  // Two rows of seats, visible only through transparent panes.
  for (const double share : {0.28, 0.62}) {
    const double x = c.roof_back + share * (c.roof_front - c.roof_back);
    for (const double side : {-1.0, 1.0}) {
      const double y = 0.5 * side * c.roof_half;
      add_box(mesh, paint_of(Material::kCloth), {x - 0.06, y - 0.2, c.floor_z + 0.01},
              {x + 0.06, y + 0.2, c.floor_z + 0.3});
    }
  }
}

Body make_car(Random& random) {
  const double l = random.between(3.8, 4.8);
  const double w = random.between(1.70, 1.86);
  const double h = random.between(1.42, 1.62);
  const bool estate = random.chance(0.4);
  Body body = body_of(kLabelCar, kLabelMovingCar, l, w);
  Mesh& mesh = body.parts[0].mesh;
  const Paint paint = random_paint(random);
  const double f = 0.5 * l;
  const double belt = 0.62 * h;
  add_extrusion(
      mesh, paint,
      {Vector2d(-f + 0.12, 0.22), Vector2d(f - 0.15, 0.20), Vector2d(f, 0.38),
       Vector2d(f - 0.04, 0.62), Vector2d(f - 0.95, belt), Vector2d(-f + 0.5, belt + 0.03),
       Vector2d(-f + 0.06, belt - 0.04), Vector2d(-f, 0.42)},
      w);
  const double rear = estate ? -f + 0.18 : -f + 0.75;
  add_cabin(mesh, {rear - 0.1, f - 1.0, rear + 0.35, f - 1.85, belt, h, 0.47 * w, 0.38 * w}, paint);
  add_wheels(mesh, {-0.29 * l, 0.3 * l}, 0.5 * w + 0.01, 0.31);
  for (const double side : {-1.0, 1.0}) {
    add_box(mesh, paint, {f - 1.35, side * (0.5 * w + 0.08) - 0.08, belt},
            {f - 1.25, side * (0.5 * w + 0.08) + 0.08, belt + 0.13});
  }
  return body;
}

Body make_van(Random& random) {
  const double l = random.between(4.9, 6.2);
  const double w = random.between(1.9, 2.1);
  const double h = random.between(1.95, 2.6);
  Body body = body_of(kLabelCar, kLabelMovingCar, l, w);
  Mesh& mesh = body.parts[0].mesh;
  const Paint paint = random_paint(random);
  const double f = 0.5 * l;
  add_extrusion(mesh, paint,
                {Vector2d(-f, 0.3), Vector2d(f, 0.28), Vector2d(f, 0.95), Vector2d(f - 0.6, 1.2),
                 Vector2d(f - 1.35, h), Vector2d(-f + 0.08, h)},
                w);
  // Panes are in front of the sheet, so that the laser hits them.
  add_box(mesh, paint_of(Material::kGlass), {f - 1.75, -0.5 * w - 0.01, 1.2},
          {f - 1.0, 0.5 * w + 0.01, h - 0.45});
  add_wheels(mesh, {-0.3 * l, 0.34 * l}, 0.5 * w + 0.01, 0.34);
  return body;
}

Body make_truck(Random& random) {
  const double l = random.between(8.0, 11.5);
  const double w = 2.5;
  const double h = random.between(3.2, 3.9);
  Body body = body_of(kLabelTruck, kLabelMovingTruck, l, w);
  Mesh& mesh = body.parts[0].mesh;
  const double f = 0.5 * l;
  const Paint cab = random_paint(random);
  add_extrusion(mesh, cab,
                {Vector2d(f - 2.0, 0.5), Vector2d(f, 0.45), Vector2d(f, 1.4),
                 Vector2d(f - 0.2, 2.7), Vector2d(f - 2.0, 2.9)},
                w - 0.1);
  add_box(mesh, paint_of(Material::kGlass), {f - 0.05, -1.05, 1.6}, {f - 0.02, 1.05, 2.4});
  if (random.chance(0.5)) {
    add_box(mesh, random_paint(random), {-f, -0.5 * w, 1.0}, {f - 2.3, 0.5 * w, h});
  } else {  // tipper: an open trough
    const Paint steel = paint_of(Material::kMetal);
    add_box(mesh, steel, {-f, -0.5 * w, 1.1}, {f - 2.3, 0.5 * w, 1.25});
    add_box(mesh, steel, {-f, -0.5 * w, 1.25}, {f - 2.3, -0.5 * w + 0.1, 2.4});
    add_box(mesh, steel, {-f, 0.5 * w - 0.1, 1.25}, {f - 2.3, 0.5 * w, 2.4});
    add_box(mesh, steel, {f - 2.4, -0.5 * w, 1.25}, {f - 2.3, 0.5 * w, 2.7});
  }
  add_box(mesh, paint_of(Material::kDarkPaint), {-f + 0.2, -0.5, 0.55}, {f - 1.0, 0.5, 1.0});
  add_wheels(mesh, {-f + 1.4, -f + 2.7, f - 1.3}, 0.5 * w, 0.5);
  return body;
}

Body make_bus(Random& random) {
  const double l = random.between(11.0, 12.5);
  Body body = body_of(kLabelBus, kLabelMovingBus, l, 2.55);
  Mesh& mesh = body.parts[0].mesh;
  const double f = 0.5 * l;
  const Paint paint = random_paint(random);
  add_box(mesh, paint, {-f, -1.275, 0.32}, {f, 1.275, 1.25});
  add_box(mesh, paint_of(Material::kGlass), {-f + 0.05, -1.26, 1.25}, {f - 0.02, 1.26, 2.45});
  add_box(mesh, paint, {-f, -1.275, 2.45}, {f, 1.275, 3.05});
  for (double x = -f; x < f; x += 1.7) {  // window posts
    add_box(mesh, paint, {x, -1.28, 1.25}, {x + 0.2, 1.28, 2.45});
  }
  add_wheels(mesh, {-f + 3.0, f - 2.7}, 1.27, 0.48);
  return body;
}

/// A tram or a train of `cars`.
Body make_tram(Random& random, int cars) {
  constexpr double kCar = 9.8;
  Body body = body_of(kLabelTram, kLabelMovingTram, kCar * (cars - 1) + 9.4, 2.4);
  body.parts.clear();
  const Paint paint = random_paint(random);
  for (int i = 0; i < cars; ++i) {
    BodyPart car;
    car.joint = BodyPart::Joint::kCar;
    car.along_m = kCar * (i - 0.5 * (cars - 1));
    const double f = 4.7;
    add_box(car.mesh, paint, {-f, -1.2, 0.25}, {f, 1.2, 1.2});
    add_box(car.mesh, paint_of(Material::kGlass), {-f + 0.04, -1.18, 1.2}, {f - 0.04, 1.18, 2.5});
    add_box(car.mesh, paint, {-f, -1.2, 2.5}, {f, 1.2, 3.3});
    for (double x = -f; x < f; x += 1.5) {
      add_box(car.mesh, paint, {x, -1.205, 1.2}, {x + 0.25, 1.205, 2.5});
    }
    body.parts.push_back(std::move(car));
  }
  return body;
}

/// A counterbalanced truck: body, overhead guard, mast, fork and its driver.
Body make_forklift(Random& random) {
  Body body = body_of(kLabelOtherVehicle, kLabelMovingOtherVehicle, 3.4, 1.2);
  Mesh& mesh = body.parts[0].mesh;
  const Paint paint = random_paint(random);
  const Paint steel = paint_of(Material::kMetal);
  add_box(mesh, paint, {-1.2, -0.58, 0.2}, {0.0, 0.58, 1.05});
  add_box(mesh, paint, {0.0, -0.5, 0.2}, {0.7, 0.5, 0.5});
  for (const double side : {-1.0, 1.0}) {
    add_tube(mesh, steel, {-0.9, 0.5 * side, 1.05}, {-0.5, 0.5 * side, 2.1}, 0.04, 0.04, 5);
    add_tube(mesh, steel, {0.6, 0.5 * side, 0.5}, {0.3, 0.5 * side, 2.1}, 0.04, 0.04, 5);
    add_box(mesh, steel, {0.72, 0.35 * side - 0.06, 0.1}, {0.85, 0.35 * side + 0.06, 2.2});
    add_box(mesh, steel, {0.85, 0.3 * side - 0.06, 0.08}, {1.95, 0.3 * side + 0.06, 0.13});
  }
  add_box(mesh, steel, {-0.6, -0.5, 2.1}, {0.4, 0.5, 2.15});
  add_box(mesh, paint_of(Material::kCloth), {-0.35, -0.22, 1.05}, {-0.05, 0.22, 1.6});
  if (random.chance(0.5)) {  // a pallet with goods
    const double height = random.between(0.6, 1.4);
    add_box(mesh, paint_of(Material::kWood), {0.87, -0.55, 0.14}, {1.9, 0.55, height});
  }
  add_wheels(mesh, {-0.9, 0.45}, 0.58, 0.25);
  return body;
}

}  // namespace

Body body_of(std::uint16_t standing, std::uint16_t moving, double length, double width) {
  Body body;
  body.parts.emplace_back();
  body.static_label = standing;
  body.moving_label = moving;
  body.length_m = length;
  body.width_m = width;
  return body;
}

const std::vector<std::string>& body_kinds() {
  static const std::vector<std::string> kinds = {"car",        "van",        "truck",   "bus",
                                                 "tram",       "motorcycle", "scooter", "cyclist",
                                                 "pedestrian", "forklift",   "train"};
  return kinds;
}

Body make_body(const std::string& kind, Random& random) {
  if (kind == "car") return make_car(random);
  if (kind == "van") return make_van(random);
  if (kind == "truck") return make_truck(random);
  if (kind == "bus") return make_bus(random);
  if (kind == "tram") return make_tram(random, 3);
  if (kind == "train") return make_tram(random, 12);
  if (kind == "motorcycle") return make_motorcyclist(random);
  if (kind == "scooter") return make_scooter_rider(random);
  if (kind == "forklift") return make_forklift(random);
  if (kind == "cyclist") return make_cyclist(random);
  if (kind == "pedestrian") return make_person(random);
  throw ConfigurationError("unknown kind of mover '" + kind + "'." +
                           suggestion(kind, body_kinds()));
}

Mesh resting_mesh(const Body& body, std::uint32_t label) {
  Mesh mesh;
  for (const BodyPart& part : body.parts) {
    mesh.append(part.mesh, placed(part.along_m, 0.0, 0.0));
  }
  for (Paint& paint : mesh.paints) paint.label = label;
  return mesh;
}

}  // namespace raymoval::simulated
