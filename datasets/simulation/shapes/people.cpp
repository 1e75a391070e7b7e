// SPDX-License-Identifier: MIT
#include <utility>

#include "datasets/simulation/shapes/bodies.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector3d;

/// A limb from a hip or shoulder to a foot or hand.
BodyPart limb(const Vector3d& from, const Vector3d& to, double thick, double thin, double amplitude,
              double phase) {
  BodyPart part;
  part.joint = BodyPart::Joint::kSwing;
  part.pivot = from;
  part.amplitude = amplitude;
  part.phase = phase;
  add_tube(part.mesh, paint_of(Material::kCloth), from, to, thick, thin, 7);
  return part;
}

void add_head(Mesh& mesh, const Vector3d& centre) {
  add_ellipsoid(mesh, paint_of(Material::kSkin), centre, {0.11, 0.09, 0.13}, 6, 9);
}

void add_spoked_wheel(Mesh& mesh, double x, double radius) {
  constexpr int kSides = 14;
  const Paint tyre = paint_of(Material::kRubber);
  const auto rim = [&](int i) {
    const auto turn = hinge(x, 0, radius, 2.0 * 3.14159265358979 * i / kSides);
    return Vector3d(turn * Vector3d(x + radius - 0.02, 0, radius));
  };
  for (int i = 0; i < kSides; ++i) add_tube(mesh, tyre, rim(i), rim(i + 1), 0.022, 0.022, 4);
  for (int i = 0; i < kSides; i += 2) {
    add_tube(mesh, paint_of(Material::kMetal), {x, 0, radius}, rim(i), 0.008, 0.006, 3);
  }
}

/// Torso, head and arms of a rider; hips at (0, 0, hip).
void add_rider(Body& body, double hip, double lean, double shoulder) {
  Mesh& mesh = body.parts[0].mesh;
  const Vector3d hips(-0.15, 0, hip);
  const Vector3d neck(-0.15 + lean, 0, hip + shoulder);
  add_tube(mesh, paint_of(Material::kCloth), hips, neck, 0.16, 0.19, 9);
  add_head(mesh, neck + Vector3d(0.08, 0, 0.2));
  for (const double side : {-1.0, 1.0}) {
    add_tube(mesh, paint_of(Material::kCloth), neck + Vector3d(0, 0.19 * side, -0.06),
             {0.42, 0.27 * side, hip + 0.12}, 0.055, 0.04, 6);
  }
}

}  // namespace

void add_bicycle(Mesh& mesh) {
  add_spoked_wheel(mesh, -0.52, 0.34);
  add_spoked_wheel(mesh, 0.52, 0.34);
  const Paint frame = paint_of(Material::kBrightPaint);
  const auto bar = [&](const Vector3d& a, const Vector3d& b) {
    add_tube(mesh, frame, a, b, 0.02, 0.02, 5);
  };
  bar({-0.52, 0, 0.34}, {-0.05, 0, 0.3});
  bar({-0.05, 0, 0.3}, {-0.18, 0, 0.92});
  bar({-0.05, 0, 0.3}, {0.38, 0, 0.8});
  bar({-0.16, 0, 0.82}, {0.38, 0, 0.85});
  bar({0.52, 0, 0.34}, {0.36, 0, 1.0});
  bar({0.40, -0.28, 1.03}, {0.40, 0.28, 1.03});
}

Body make_person(Random& random) {
  const double scale = random.between(0.88, 1.08);  // of 1.75 m
  Body body = body_of(kLabelPerson, kLabelMovingPerson, 0.5, 0.55);
  const double hip = 0.88 * scale;
  const double shoulder = 1.42 * scale;
  Mesh& trunk = body.parts[0].mesh;
  add_tube(trunk, paint_of(Material::kCloth), {0, 0, hip - 0.05}, {0, 0, shoulder}, 0.15, 0.20, 10);
  add_tube(trunk, paint_of(Material::kSkin), {0, 0, shoulder}, {0, 0, shoulder + 0.1}, 0.06, 0.06,
           6);
  add_head(trunk, {0.02, 0, shoulder + 0.21});
  if (random.chance(0.3)) {  // a rucksack
    add_box(trunk, paint_of(Material::kCloth), {-0.36, -0.15, hip + 0.1}, {-0.17, 0.15, shoulder});
  }
  for (const double side : {-1.0, 1.0}) {
    const double phase = side > 0 ? 0.0 : 0.5;
    const double leg = 0.11 * side;
    const double arm = 0.25 * side;
    body.parts.push_back(limb({0, leg, hip}, {0.03, leg, 0.02}, 0.09, 0.06, 0.45, phase));
    body.parts.push_back(
        limb({0, arm, shoulder - 0.05}, {0.05, arm, hip - 0.08}, 0.055, 0.04, 0.4, phase + 0.5));
  }
  return body;
}

Body make_cyclist(Random& random) {
  Body body = body_of(kLabelBicyclist, kLabelMovingBicyclist, 1.75, 0.6);
  body.stride_m = 4.5;
  body.pace_mps = 3.0;
  Mesh& mesh = body.parts[0].mesh;
  add_bicycle(mesh);
  add_rider(body, 0.93, random.between(0.2, 0.45), 0.55);
  for (const double side : {-1.0, 1.0}) {
    body.parts.push_back(limb({-0.15, 0.1 * side, 0.93}, {0.12, 0.1 * side, 0.2}, 0.09, 0.055, 0.35,
                              side > 0 ? 0.0 : 0.5));
  }
  return body;
}

Body make_motorcyclist(Random& random) {
  Body body = body_of(kLabelMotorcyclist, kLabelMovingMotorcyclist, 2.1, 0.75);
  Mesh& mesh = body.parts[0].mesh;
  const Paint rubber = paint_of(Material::kRubber);
  add_tube(mesh, rubber, {-0.72, -0.08, 0.31}, {-0.72, 0.08, 0.31}, 0.31, 0.31, 14);
  add_tube(mesh, rubber, {0.72, -0.06, 0.31}, {0.72, 0.06, 0.31}, 0.31, 0.31, 14);
  const Paint paint = paint_of(random.chance(0.5) ? Material::kBrightPaint : Material::kDarkPaint);
  add_box(mesh, paint, {-0.45, -0.17, 0.3}, {0.42, 0.17, 0.82});
  add_box(mesh, paint, {-0.85, -0.14, 0.74}, {-0.1, 0.14, 0.86});
  add_tube(mesh, paint_of(Material::kMetal), {0.72, 0, 0.31}, {0.45, 0, 1.05}, 0.07, 0.06, 6);
  add_tube(mesh, paint_of(Material::kMetal), {0.42, -0.36, 1.05}, {0.42, 0.36, 1.05}, 0.03, 0.03,
           5);
  add_rider(body, 0.88, random.between(0.15, 0.35), 0.56);
  for (const double side : {-1.0, 1.0}) {
    add_tube(mesh, paint_of(Material::kCloth), {-0.15, 0.15 * side, 0.88}, {0.25, 0.24 * side, 0.6},
             0.1, 0.08, 6);
    add_tube(mesh, paint_of(Material::kCloth), {0.25, 0.24 * side, 0.6}, {-0.05, 0.24 * side, 0.3},
             0.08, 0.06, 6);
  }
  return body;
}

Body make_scooter_rider(Random& random) {
  Body body = body_of(kLabelMotorcyclist, kLabelMovingMotorcyclist, 1.8, 0.65);
  Mesh& mesh = body.parts[0].mesh;
  const Paint rubber = paint_of(Material::kRubber);
  add_tube(mesh, rubber, {-0.6, -0.06, 0.24}, {-0.6, 0.06, 0.24}, 0.24, 0.24, 12);
  add_tube(mesh, rubber, {0.63, -0.05, 0.24}, {0.63, 0.05, 0.24}, 0.24, 0.24, 12);
  const Paint paint = paint_of(random.chance(0.5) ? Material::kBrightPaint : Material::kDarkPaint);
  add_box(mesh, paint, {-0.82, -0.16, 0.32}, {-0.12, 0.16, 0.76});
  add_box(mesh, paint, {-0.12, -0.2, 0.24}, {0.36, 0.2, 0.32});
  add_box(mesh, paint, {0.36, -0.22, 0.26}, {0.46, 0.22, 0.85});
  add_tube(mesh, paint_of(Material::kMetal), {0.62, 0, 0.24}, {0.42, 0, 1.0}, 0.06, 0.05, 6);
  add_tube(mesh, paint_of(Material::kMetal), {0.38, -0.32, 1.0}, {0.38, 0.32, 1.0}, 0.03, 0.03, 5);
  add_rider(body, 0.8, random.between(0.0, 0.15), 0.5);
  for (const double side : {-1.0, 1.0}) {
    add_tube(mesh, paint_of(Material::kCloth), {-0.2, 0.12 * side, 0.8}, {0.22, 0.14 * side, 0.76},
             0.1, 0.08, 6);
    add_tube(mesh, paint_of(Material::kCloth), {0.22, 0.14 * side, 0.76}, {0.15, 0.14 * side, 0.33},
             0.08, 0.06, 6);
  }
  return body;
}

}  // namespace raymoval::simulated
