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

/// Poses of a file, unchecked, in the order of the file (g2o: of the ids). `rigid_pose` checks a
/// pose.
struct PoseFile {
  struct Row {
    Eigen::Matrix<double, 3, 4> matrix;
    std::size_t line = 0;  ///< Counted from 1: the line of a text, else the number of the pose.
    std::optional<Nanoseconds> stamp = std::nullopt;  ///< All rows have one, or none has.
    std::optional<long> frame = std::nullopt;  ///< Frame number; all rows have one, or none has.

    /// False for a row without a pose (nan).
    [[nodiscard]] bool has_pose() const { return matrix.allFinite(); }
  };
  std::filesystem::path path;
  std::string format;            ///< Its name in the list of formats, "tum".
  bool is_binary = false;        ///< Whether it has no lines.
  bool of_sensor = false;        ///< Whether it ends in `kSensorPoses`.
  bool has_quaternions = false;  ///< Whether the rotations are written as quaternions.
  std::vector<Row> rows;         ///< At least one.
  /// Conclusions on facts that the file does not state, in whole sentences: the unit of its times.
  std::vector<std::string> notes;

  [[nodiscard]] bool stamped() const { return rows.front().stamp.has_value(); }
  /// "poses.txt: line 12" or "poses.npy: pose 12".
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// The comment at the end of pose files of this program: the poses are those of the sensor,
/// whatever the sequence says about the poses of its own file.
inline constexpr const char* kSensorPoses = "# poses of the sensor, by raymoval\n";

/// A pose format in messages.
struct PoseFormatName {
  std::string name;      ///< "tum".
  std::string sentence;  ///< Its content and the programs that write it.
};

/// All formats of `read_pose_file`.
std::vector<PoseFormatName> pose_format_names();

/// Facts that a file does not state.
struct PoseReading {
  /// Name of a format; if empty, it is detected from the content. A suffix ":inverse", or "inverse"
  /// alone: the poses map the world to the body.
  std::optional<std::string> format;
};

/// Reads a pose file of any format of `pose_format_names`. Empty lines and comments (#) are
/// skipped. Times are exact to the nanosecond. Rows are sorted by time; times may be equal.
/// @throws DataError with file, line and column for a word that is no number; with file and line
///   for a wrong number of columns, a quaternion that is not of unit length, a fourth row that is
///   not 0 0 0 1, or two poses of one time that are more than 0.2 m apart; with the remedy for a
///   file of ambiguous format. UsageError for an unknown name of a format
PoseFile read_pose_file(const std::filesystem::path& path, const PoseReading& reading = {});

/// Row `row` as a rigid motion. @throws DataError as `rigid_pose` of a matrix, naming file and line
Pose rigid_pose(const PoseFile& file, std::size_t row);

/// The poses of a file with times. Rows without a pose are left out (at the ends, the motion is
/// extrapolated for up to 0.2 s), and poses of one time are averaged.
/// @param notes gets the number of these rows
/// @throws DataError as above, and if no row has a pose
std::vector<StampedPose> stamped_poses(const PoseFile& file, std::vector<std::string>& notes);

}  // namespace raymoval
