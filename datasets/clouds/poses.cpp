// SPDX-License-Identifier: MIT
#include "datasets/clouds/poses.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kTolerance = 1e-3;
/// Below this a matrix is a rotation up to rounding and is left as it is.
constexpr double kRounding = 1e-14;

std::string line_text(const std::filesystem::path& path, std::size_t line) {
  return path.string() + ": line " + std::to_string(line);
}

/// Calls `visit(line, number)` for each line that is neither blank nor a comment.
template <class Visit>
void for_each_line(std::string_view text, Visit&& visit) {
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::size_t start = line.find_first_not_of(" \t\r");
    if (start != std::string_view::npos && line[start] != '#') visit(line, number);
  }
}

Eigen::Matrix<double, 3, 4> kitti_matrix(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
}

/// The numbers of one line. @param first_column column of `text` in its line, from 1
/// @throws DataError with file, line and column
std::vector<double> parse_numbers(std::string_view text, const std::filesystem::path& path,
                                  std::size_t line, std::size_t first_column = 1) {
  std::vector<double> numbers;
  for (const std::string_view piece : split_blanks(text)) {
    const auto value = parse_number<double>(piece);
    if (!value) {
      const auto column = static_cast<std::size_t>(piece.data() - text.data()) + first_column;
      throw DataError(line_text(path, line) + ", column " + std::to_string(column) + ": '" +
                      std::string(piece.substr(0, 40)) +
                      "' is not a number; expected numbers separated by blanks.");
    }
    numbers.push_back(*value);
  }
  return numbers;
}

}  // namespace

Pose rigid_pose(const Eigen::Matrix<double, 3, 4>& matrix, const std::string& where) {
  if (!matrix.allFinite()) {
    throw DataError(where + ": the pose holds a number that is not finite (nan or inf). " +
                    "Take a trajectory that has a pose there.");
  }
  Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm();
  const double determinant = rotation.determinant();
  if (!(deviation <= kTolerance) || determinant < 0.0) {
    throw DataError(where +
                    ": the 3 x 3 part is not a rotation: |R^T R - I| = " + number_text(deviation) +
                    " (at most 0.001), det R = " + number_text(determinant) +
                    " (expected +1). Expected a rigid pose r11 r12 r13 tx r21 ... tz.");
  }
  if (deviation > kRounding) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    rotation = svd.matrixU() * svd.matrixV().transpose();
  }
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = matrix.col(3);
  return pose;
}

Pose rigid_pose(const Eigen::Vector3d& position, const Eigen::Vector4d& wxyz,
                const std::string& where) {
  const double length = wxyz.norm();
  if (!position.allFinite() || !wxyz.allFinite()) {
    throw DataError(where + ": the pose holds a number that is not finite (nan or inf).");
  }
  if (!(std::abs(length - 1.0) <= kTolerance)) {
    throw DataError(where + ": the quaternion has length " + number_text(length) +
                    ", expected 1 within " + number_text(kTolerance) +
                    ". Check the order of the columns, or write it with more digits.");
  }
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

Pose read_calibration(const std::filesystem::path& path, const std::string& key) {
  std::vector<std::string> found;
  std::optional<Pose> pose;
  for_each_line(read_text(path), [&](std::string_view line, std::size_t number) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return;
    const auto name = split_blanks(line.substr(0, colon));
    found.emplace_back(name.empty() ? "" : name.front());
    if (found.back() != key) return;
    const auto numbers = parse_numbers(line.substr(colon + 1), path, number, colon + 2);
    const std::string where = line_text(path, number) + ": " + key;
    if (numbers.size() != 12) {
      throw DataError(where + " has " + std::to_string(numbers.size()) +
                      " numbers; expected 12 (a 3 x 4 matrix row by row).");
    }
    pose = rigid_pose(kitti_matrix(numbers), where);
  });
  if (pose) return *pose;
  throw DataError(
      path.string() + ": has no row '" + key + ":' (LiDAR to camera); found " +
      (found.empty() ? "no row" : join(found)) +
      ". If the poses are those of the LiDAR, set \"poses_are_lidar\": true in sequence.json.");
}

}  // namespace raymoval
