// SPDX-License-Identifier: MIT
#include "datasets/clouds/poses.h"

#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_poses(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const PoseFile file = read_pose_file(fuzz::input_file("poses.txt", bytes));
    for (std::size_t row = 0; row < file.rows.size(); ++row) {
      fuzz::may_refuse([&] {
        const Eigen::Matrix3d rotation = rigid_pose(file, row).linear();
        const auto off = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
        fuzz::require(off.norm() < 1e-9, "a pose is not rigid");
      });
    }
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(poses, try_poses)
