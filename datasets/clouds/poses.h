// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// Rows of a pose file as they stand there; `rigid_pose` checks one.
struct PoseFile {
  struct Row {
    Eigen::Matrix<double, 3, 4> matrix;
    std::size_t line = 0;          ///< Counted from 1.
    std::optional<double> time_s;  ///< TUM only.
  };
  std::filesystem::path path;
  std::vector<Row> rows;
};

/// Reads KITTI rows (12 numbers: a 3 x 4 matrix row by row) or TUM rows (t x y z qx qy qz qw, unit
/// quaternion, times not decreasing), told apart by the count of numbers in the first row. Empty
/// lines and lines that start with # are skipped.
/// @throws DataError with file, line and column for what is no number, with file and line for a
///   wrong count of numbers, a quaternion that is not of unit length, or a time that runs backwards
PoseFile read_pose_file(const std::filesystem::path& path);

/// Row `row` as a rigid motion; small deviations from a rotation are removed (nearest rotation in
/// the Frobenius norm, by singular value decomposition).
/// @throws DataError naming file and line if a number is not finite, |R^T R - I| > 1e-3, or
///   det R < 0
Pose rigid_pose(const PoseFile& file, std::size_t row);

/// The same for a bare matrix. @param where begins the message, such as "calib.txt: line 5"
Pose rigid_pose(const Eigen::Matrix<double, 3, 4>& matrix, const std::string& where);

/// Position and quaternion (w x y z) as a rigid motion.
/// @throws DataError if a number is not finite or the length of the quaternion is not 1 +- 1e-3
Pose rigid_pose(const Eigen::Vector3d& position, const Eigen::Vector4d& wxyz,
                const std::string& where);

/// The row `key:` (12 numbers) of a KITTI calibration file.
/// @throws DataError if the row is missing (naming those there are) or damaged
Pose read_calibration(const std::filesystem::path& path, const std::string& key);

/// One number a line, such as KITTI's times.txt. @throws DataError with line and column
std::vector<double> read_number_column(const std::filesystem::path& path);

}  // namespace raymoval
