// SPDX-License-Identifier: MIT
#include "datasets/simulation/shapes/shapes.h"

#include <cmath>
#include <numbers>

namespace raymoval::simulated {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Isometry3d placed(double x, double y, double z, double yaw) {
  Isometry3d motion = Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  motion.translation() = Vector3d(x, y, z);
  return motion;
}

Isometry3d hinge(double x, double y, double z, double angle) {
  const Vector3d pivot(x, y, z);
  Isometry3d motion = Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
  motion.translation() = pivot - motion.linear() * pivot;
  return motion;
}

void add_quad(Mesh& mesh, Paint paint, const Vector3d& a, const Vector3d& b, const Vector3d& c,
              const Vector3d& d) {
  const auto i = mesh.vertex(a);
  mesh.vertex(b);
  mesh.vertex(c);
  mesh.vertex(d);
  mesh.triangle(i, i + 1, i + 2, paint);
  mesh.triangle(i, i + 2, i + 3, paint);
}

void add_frustum(Mesh& mesh, Paint sides, Paint lid, const std::array<Vector3d, 4>& below,
                 const std::array<Vector3d, 4>& above) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    add_quad(mesh, sides, below[i], below[j], above[j], above[i]);
  }
  add_quad(mesh, lid, below[0], below[1], below[2], below[3]);
  add_quad(mesh, lid, above[0], above[1], above[2], above[3]);
}

void add_box(Mesh& mesh, Paint paint, const Vector3d& low, const Vector3d& high,
             const Isometry3d& frame) {
  const auto corner = [&](double x, double y, double z) { return frame * Vector3d(x, y, z); };
  const auto layer = [&](double z) {
    return std::array<Vector3d, 4>{corner(low.x(), low.y(), z), corner(high.x(), low.y(), z),
                                   corner(high.x(), high.y(), z), corner(low.x(), high.y(), z)};
  };
  add_frustum(mesh, paint, paint, layer(low.z()), layer(high.z()));
}

void add_tube(Mesh& mesh, Paint paint, const Vector3d& from, const Vector3d& to, double radius_from,
              double radius_to, int sides) {
  const Vector3d axis = (to - from).normalized();
  const Vector3d helper = std::abs(axis.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d u = axis.cross(helper).normalized();
  const Vector3d v = axis.cross(u);
  const auto first = mesh.vertex(from);
  mesh.vertex(to);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const Vector3d out = std::cos(angle) * u + std::sin(angle) * v;
    mesh.vertex(from + radius_from * out);
    mesh.vertex(to + radius_to * out);
  }
  for (int i = 0; i < sides; ++i) {
    const auto a = first + 2 + 2 * static_cast<std::uint32_t>(i);
    const auto b = first + 2 + 2 * static_cast<std::uint32_t>((i + 1) % sides);
    mesh.triangle(a, b, b + 1, paint);
    mesh.triangle(a, b + 1, a + 1, paint);
    mesh.triangle(first, a, b, paint);
    mesh.triangle(first + 1, a + 1, b + 1, paint);
  }
}

void add_ellipsoid(Mesh& mesh, Paint paint, const Vector3d& centre, const Vector3d& radii,
                   int rings, int sides) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int r = 0; r <= rings; ++r) {
    const double polar = std::numbers::pi * r / rings;
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / sides;
      const Vector3d unit(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                          std::cos(polar));
      mesh.vertex(centre + radii.cwiseProduct(unit));
    }
  }
  const auto at = [&](int r, int s) {
    return first + static_cast<std::uint32_t>(r * sides + s % sides);
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sides; ++s) {
      if (r > 0) mesh.triangle(at(r, s), at(r + 1, s), at(r, s + 1), paint);
      if (r < rings - 1) mesh.triangle(at(r, s + 1), at(r + 1, s), at(r + 1, s + 1), paint);
    }
  }
}

void add_extrusion(Mesh& mesh, Paint paint, const std::vector<Vector2d>& outline, double width) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector2d& p : outline) {
    mesh.vertex({p.x(), -0.5 * width, p.y()});
    mesh.vertex({p.x(), 0.5 * width, p.y()});
  }
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = first + 2 * i;
    const std::uint32_t b = first + 2 * ((i + 1) % count);
    mesh.triangle(a, b, b + 1, paint);
    mesh.triangle(a, b + 1, a + 1, paint);
    if (i >= 1 && i + 1 < count) {
      mesh.triangle(first, a, b, paint);
      mesh.triangle(first + 1, a + 1, b + 1, paint);
    }
  }
}

void add_leaf(Mesh& mesh, Paint paint, const Vector3d& centre, double leaf, Random& random) {
  Vector3d u = random.within(-Vector3d::Ones(), Vector3d::Ones());
  Vector3d v = random.within(-Vector3d::Ones(), Vector3d::Ones());
  if (u.cross(v).norm() < 1e-3) {
    u = Vector3d::UnitX();
    v = Vector3d::UnitZ();
  }
  u.normalize();
  v = (v - v.dot(u) * u).normalized();
  const double half = 0.5 * leaf * random.between(0.6, 1.4);
  add_quad(mesh, paint, centre - half * u - half * v, centre + half * u - half * v,
           centre + half * u + half * v, centre - half * u + half * v);
}

void add_leaves(Mesh& mesh, Paint paint, const Vector3d& centre, const Vector3d& radii, double leaf,
                int count, Random& random) {
  constexpr int kCluster = 6;  // leaves grow at twigs, so there are gaps between
  for (int i = 0; i < count;) {
    const Vector3d unit = random.within(-Vector3d::Ones(), Vector3d::Ones());
    const double norm = unit.norm();
    if (norm > 1.0 || !random.chance(0.15 + 0.85 * norm)) continue;
    const Vector3d twig = centre + radii.cwiseProduct(unit);
    for (int k = 0; k < kCluster && i < count; ++k, ++i) {
      const Vector3d off = random.normals();
      add_leaf(mesh, paint, twig + 0.75 * leaf * off, leaf, random);
    }
  }
}

}  // namespace raymoval::simulated
