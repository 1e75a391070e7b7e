// SPDX-License-Identifier: MIT
#include "core/scan/local_frame.h"

#include <catch2/catch.hpp>

#include "tests/methods/held_scans.h"

using namespace raymoval;
using Eigen::Vector3d;

namespace {

/// One point ahead of the sensor in each scan; scans a metre apart along x.
class Row : public toy::HeldScans {
 public:
  explicit Row(const Vector3d& first) {
    for (int x = 0; x < 3; ++x) {
      add({{5.0F, 0.0F, 0.0F}}, Pose(Eigen::Translation3d(first + Vector3d(x, 0, 0))));
    }
  }
};

}  // namespace

TEST_CASE("methods start at zero wherever the world's origin is, to the last bit") {
  for (const Vector3d& first : {Vector3d(0, 0, 0), Vector3d(691000.25, 5336000.5, 512)}) {
    const Row scans(first);
    const LocalFrameSource local(scans, method_frame(scans, Vector3d::UnitZ()));
    CHECK(local.pose(0).matrix() == Eigen::Matrix4d::Identity());
    CHECK(local.pose(2).translation() == Vector3d(2, 0, 0));
    CHECK(local.load(2).T_world_sensor.translation() == Vector3d(2, 0, 0));
    CHECK(local.load(1).points == scans.load(1).points);
  }
}

TEST_CASE("a spin axis becomes z of the sensor frame, and no point moves in the world") {
  const Row scans({3, 4, 5});
  Pose up = Pose::Identity();
  up.linear() = turn_to_z(Vector3d::UnitX());
  const LocalFrameSource local(scans, up, Vector3d::UnitY());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan before = scans.load(i), after = local.load(i);
    CHECK(after.T_world_sensor.matrix() == local.pose(i).matrix());
    CHECK((after.T_world_sensor * after.points[0].cast<double>())
              .isApprox(up * (before.T_world_sensor * before.points[0].cast<double>())));
    // y of the old frame is z of the new one.
    CHECK(after.T_world_sensor.linear().col(2) ==
          (up * before.T_world_sensor).linear() * Vector3d::UnitY());
  }
  CHECK(local.sensor().spin_axis == Vector3d::UnitZ());
}

TEST_CASE("up becomes z by the shortest turn, exactly where axes are exchanged") {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vector3d up = Vector3d::Unit(axis) * sign;
      const Eigen::Matrix3d turn = turn_to_z(up);
      CHECK(turn * up == Vector3d::UnitZ());
      CHECK(turn.determinant() == 1.0);
      CHECK(turn.cwiseAbs().sum() == 3.0);  // A permutation of axes: lattices stay lattices.
    }
  }
  CHECK(turn_to_z(Vector3d::UnitZ()) == Eigen::Matrix3d::Identity());
  const Vector3d tilted = Vector3d(0.3, -0.2, 0.9).normalized();
  CHECK((turn_to_z(tilted) * tilted - Vector3d::UnitZ()).norm() < 1e-12);
  CHECK(turn_to_z(tilted).isUnitary(1e-12));
}

TEST_CASE("scores are counted from a whole kilometre, and from the world's origin near it") {
  CHECK(lattice_origin(Row({0, 0, 0})) == Vector3d::Zero());
  CHECK(lattice_origin(Row({-7999, 7999, 300})) == Vector3d::Zero());
  CHECK(lattice_origin(Row({691234.5, -5336789.0, 512.3})) == Vector3d(691000, -5337000, 1000));
  const Row far({691000.25, 5336000.5, 512});
  CHECK(LocalFrameSource(far, lattice_frame(far)).pose(1).translation() ==
        Vector3d(1.25, 0.5, -488));
}
