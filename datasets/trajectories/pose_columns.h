// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/pose_text.h"
#include "datasets/trajectories/stamps.h"

namespace raymoval::pose_formats {

/// How a row of numbers says a rotation.
enum class Rotation {
  kMatrix3x4,     ///< Twelve numbers with the position among them.
  kMatrix4x4,     ///< Sixteen; the last four are 0 0 0 1.
  kQuaternion,    ///< x y z w.
  kVector,        ///< Axis times angle, radians.
  kEulerRadians,  ///< Roll, pitch, yaw of Rz(yaw) Ry(pitch) Rx(roll).
  kEulerDegrees,
};

/// Which of the numbers of a row mean what.
struct PoseColumns {
  std::size_t count = 0;           ///< Words in a row.
  bool others_are_numbers = true;  ///< Whether words that are not used have to be numbers.
  Rotation rotation = Rotation::kQuaternion;
  std::size_t matrix = 0;                       ///< First number of a matrix.
  std::array<std::size_t, 3> position = {};     ///< x y z, if there is no matrix.
  std::array<std::size_t, 4> turn = {};         ///< The numbers of the rotation, in its order.
  std::optional<std::size_t> time;              ///< Seconds, or as `unit` says.
  std::optional<std::size_t> nanoseconds;       ///< To be added to whole seconds in `time`.
  std::optional<TimeUnit> unit = std::nullopt;  ///< Nothing: to be told by the times.
};

/// The pose in a row of numbers.
/// @throws DataError that begins with `where` for a bad quaternion or fourth row
Eigen::Matrix<double, 3, 4> pose_matrix(const std::vector<double>& numbers,
                                        const PoseColumns& columns, const std::string& where);

/// Reads all rows of a text.
/// @throws DataError naming file and line for a row with another count of numbers
PoseFile read_columns(const PoseText& text, const PoseColumns& columns);

/// Gives the rows of `file` their times.
/// @param words a time for each row, and `extra` nanoseconds to be added to it, or nothing
/// @throws DataError for what is no time
void set_stamps(PoseFile& file, const std::vector<std::string_view>& words,
                const std::vector<std::string_view>& extra, std::optional<TimeUnit> unit);

}  // namespace raymoval::pose_formats
