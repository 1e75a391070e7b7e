// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// Poses as a file has them, in the order of the file (g2o: in that of the ids); `rigid_pose`
/// checks one.
struct PoseFile {
  struct Row {
    Eigen::Matrix<double, 3, 4> matrix;
    std::size_t line = 0;  ///< Counted from 1: the line of a text, else the number of the pose.
    std::optional<Nanoseconds> stamp = std::nullopt;  ///< All rows have one, or none has.
    std::optional<long> frame =
        std::nullopt;  ///< Number of its scan; all rows have one, or none has.

    /// False for a row in which the program that wrote it has no pose (nan).
    [[nodiscard]] bool has_pose() const { return matrix.allFinite(); }
  };
  std::filesystem::path path;
  std::string format;            ///< Its name in the list of formats, "tum".
  bool is_binary = false;        ///< Whether it has no lines.
  bool has_quaternions = false;  ///< Whether the rotations are written as quaternions.
  std::vector<Row> rows;         ///< At least one.
  /// What the file did not say and was concluded, in whole sentences: the unit of its times.
  std::vector<std::string> notes;

  [[nodiscard]] bool stamped() const { return rows.front().stamp.has_value(); }
  /// "poses.txt: line 12" or "poses.npy: pose 12".
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// A form of pose file, as users see it.
struct PoseFormatName {
  std::string name;      ///< "tum".
  std::string sentence;  ///< What is in it, and who writes it.
};

/// All that `read_pose_file` reads.
std::vector<PoseFormatName> pose_format_names();

/// What a file does not say of itself.
struct PoseReading {
  /// Name of a format; nothing: it is told by the content. ":inverse" behind it, or "inverse"
  /// alone, says that the poses take the world to the body.
  std::optional<std::string> format;
};

/// Reads a pose file of any form that `pose_format_names` lists. Empty lines and comments (#) are
/// skipped. Times are exact to the nanosecond. Rows are put in their order; equal ones may be
/// there.
/// @throws DataError with file, line and column for what is no number, with file and line for a
///   wrong count of numbers, a quaternion that is not of unit length, a fourth row that is not 0 0
///   0 1, or two poses of one time that are more than 0.2 m apart; with the remedy for a file whose
///   form cannot be told. UsageError for an unknown name of a format
PoseFile read_pose_file(const std::filesystem::path& path, const PoseReading& reading = {});

/// Row `row` as a rigid motion. @throws DataError as `rigid_pose` of a matrix, naming file and line
Pose rigid_pose(const PoseFile& file, std::size_t row);

/// The poses of a file with times: rows without a pose are left out (at the ends the motion
/// goes on for up to 0.2 s), and those of one time are averaged. @param notes gets how many these
/// are @throws DataError as above, and for no pose
std::vector<StampedPose> stamped_poses(const PoseFile& file, std::vector<std::string>& notes);
/// The same as a trajectory. @throws InternalError if it has no times, DataError as above
Trajectory trajectory_of(const PoseFile& file);

}  // namespace raymoval
