// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {

/// Translation by (x, y, z) after a turn by `yaw` (radians) about z.
Eigen::Isometry3d placed(double x, double y, double z, double yaw = 0.0);
/// Turn by `angle` (radians) about the y axis through (x, y, z): a hinge of a leg or a boom.
Eigen::Isometry3d hinge(double x, double y, double z, double angle);

/// A flat four-cornered face, corners in order around it.
void add_quad(Mesh& mesh, Paint paint, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              const Eigen::Vector3d& c, const Eigen::Vector3d& d);
/// Box with its edges along the axes of `frame`, from `low` to `high`.
void add_box(Mesh& mesh, Paint paint, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             const Eigen::Isometry3d& frame = Eigen::Isometry3d::Identity());
/// Six-sided body: four corners below (around), four above; sides, lid and floor painted apart.
void add_frustum(Mesh& mesh, Paint sides, Paint lid, const std::array<Eigen::Vector3d, 4>& below,
                 const std::array<Eigen::Vector3d, 4>& above);
/// Cone frustum or cylinder between two points, `sides` faces around, closed at both ends.
void add_tube(Mesh& mesh, Paint paint, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              double radius_from, double radius_to, int sides);
/// Ellipsoid of `rings` x `sides` faces.
void add_ellipsoid(Mesh& mesh, Paint paint, const Eigen::Vector3d& centre,
                   const Eigen::Vector3d& radii, int rings, int sides);
/// A convex outline in the x-z plane, extruded over y from -width / 2 to width / 2.
void add_extrusion(Mesh& mesh, Paint paint, const std::vector<Eigen::Vector2d>& outline,
                   double width);
/// `count` leaf clusters, squares of random turn and of `leaf` metres at twigs in an ellipsoid;
/// more of them near its skin, where a crown has its leaves.
void add_leaves(Mesh& mesh, Paint paint, const Eigen::Vector3d& centre,
                const Eigen::Vector3d& radii, double leaf, int count, Random& random);
/// One square of random turn at `centre`.
void add_leaf(Mesh& mesh, Paint paint, const Eigen::Vector3d& centre, double leaf, Random& random);

}  // namespace raymoval::simulated
