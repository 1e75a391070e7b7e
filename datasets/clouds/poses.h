// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "core/scan/scan.h"

namespace raymoval {

/// A matrix as a rigid motion; small deviations from a rotation are removed (nearest rotation in
/// the Frobenius norm, by singular value decomposition).
/// @param where begins the message, such as "calib.txt: line 5"
/// @throws DataError if a number is not finite, |R^T R - I| > 1e-3, or det R < 0
Pose rigid_pose(const Eigen::Matrix<double, 3, 4>& matrix, const std::string& where);

/// Position and quaternion (w x y z) as a rigid motion.
/// @throws DataError if a number is not finite or the length of the quaternion is not 1 +- 1e-3
Pose rigid_pose(const Eigen::Vector3d& position, const Eigen::Vector4d& wxyz,
                const std::string& where);

/// The row `key:` (12 numbers) of a KITTI calibration file.
/// @throws DataError if the row is missing (naming those there are) or damaged
Pose read_calibration(const std::filesystem::path& path, const std::string& key);

}  // namespace raymoval
