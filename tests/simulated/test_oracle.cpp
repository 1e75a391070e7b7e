// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "datasets/simulation/sensor/ray_tracer.h"
#include "datasets/simulation/shapes/random.h"
#include "tests/simulated/scenes.h"

using namespace raymoval;
using namespace raymoval::simulated;
using Eigen::Vector3d;

namespace {

/// Distance along a ray to a triangle, or 1e9 (Moeller and Trumbore 1997), in double precision.
/// `margin` grows the triangle; a negative one shrinks it.
double triangle_range(const Ray& ray, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                      double margin) {
  const Vector3d e1 = b - a;
  const Vector3d e2 = c - a;
  const Vector3d p = ray.direction.cross(e2);
  const double det = e1.dot(p);
  const Vector3d t = ray.origin - a;
  const double u = t.dot(p) / det;
  const Vector3d q = t.cross(e1);
  const double v = ray.direction.dot(q) / det;
  const double range = e2.dot(q) / det;
  const bool inside = u >= -margin && v >= -margin && u + v <= 1.0 + margin;
  return inside && range > 0.01 ? range : 1e9;
}

}  // namespace

TEST_CASE("the tracer finds what trying every triangle finds") {
  // 300 random triangles around the sensor in two tiles, and 1003 rays (no multiple of the packet
  // size). Rays that pass an edge within a hundred-thousandth of a triangle may go either way.
  Random random(4, Purpose::kPart);
  const Vector3d centre(95.0, 50.0, 0.0);
  World world;
  std::vector<std::array<Vector3d, 3>> triangles;
  for (int i = 0; i < 300; ++i) {
    Mesh mesh;
    const Vector3d at(random.between(-20, 20), random.between(-20, 20), random.between(-20, 20));
    std::array<Vector3d, 3> corners;
    for (Vector3d& corner : corners) {
      const Vector3d off(random.normal(), random.normal(), random.normal());
      corner = mesh.vertices.emplace_back((2.0 * off).cast<float>()).cast<double>() + at;
    }
    mesh.triangle(0, 1, 2, {Material::kPerfect, static_cast<std::uint32_t>(i + 1)});
    world.add_static(mesh, Eigen::Isometry3d(Eigen::Translation3d(at + centre)));
    triangles.push_back(corners);
  }
  world.finish();
  REQUIRE(world.tiles().size() > 1);
  const RayTracer tracer(world, 200.0, 1);
  const RayTracer::Moment moment(tracer, centre, {{}});
  std::vector<Ray> rays(1003);
  for (Ray& ray : rays) {
    ray.direction = random.normals().normalized();
  }
  std::vector<Hit> hits(rays.size());
  moment.trace(rays, hits);
  std::size_t met = 0;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    double generous = 1e9;
    double strict = 1e9;
    for (const auto& [a, b, c] : triangles) {
      generous = std::min(generous, triangle_range(rays[r], a, b, c, 1e-5));
      strict = std::min(strict, triangle_range(rays[r], a, b, c, -1e-5));
    }
    if (std::abs(generous - strict) > 1e-9) continue;  // at an edge
    CHECK(hits[r].found() == (strict < 1e8));
    if (!hits[r].found()) continue;
    CHECK(std::abs(hits[r].range - strict) < 1e-4);
    ++met;
  }
  CHECK(met > 200);
}
