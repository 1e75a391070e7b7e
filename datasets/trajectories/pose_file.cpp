// SPDX-License-Identifier: MIT
#include "datasets/trajectories/pose_file.h"

#include <algorithm>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/poses.h"
#include "datasets/trajectories/pose_format.h"

namespace raymoval {
namespace {

using pose_formats::Match;
using pose_formats::PoseText;
using pose_formats::TextFormat;

/// All text formats. Named columns come first, because names are more certain than the number of
/// columns.
const std::vector<TextFormat>& text_formats() {
  static const std::vector<TextFormat> all = [] {
    std::vector<TextFormat> list = {pose_formats::g2o_format(),
                                    pose_formats::named_columns_format()};
    for (TextFormat& format : pose_formats::column_formats()) list.push_back(std::move(format));
    return list;
  }();
  return all;
}

constexpr const char* kList = "`raymoval list pose-formats` names all forms.";

[[noreturn]] void throw_unknown(const PoseText& text) {
  const auto& row = text.first();
  if (text.has_header()) {
    throw DataError(text.path().string() + ": names no columns for a pose (" +
                    std::string(text.names().front().substr(0, 40)) +
                    ", ...); expected x y z with qx qy qz qw or roll pitch yaw. " + kList);
  }
  if (row.words.empty()) {
    throw DataError(text.path().string() +
                    ": holds no pose; expected one a row, such as 12 "
                    "(KITTI) or 8 (TUM) numbers. " +
                    kList);
  }
  (void)text.numbers(row);  // Reports a word that is no number first.
  std::string also;
  for (const TextFormat& format : text_formats()) {
    if (format.match(text) == Match::kPossible) {
      also = " Say --pose-format " + format.name.name + " for " + format.name.sentence + ".";
    }
  }
  throw DataError(text.place(row.line) + ": " + std::to_string(row.words.size()) +
                  " numbers; expected 12 (KITTI, a 3 x 4 matrix row by row), 16 (4 x 4) or 8 (TUM, "
                  "t x y z qx qy qz qw), or a line with the names of the columns." +
                  also + " " + kList);
}

const TextFormat& format_of(const PoseText& text, const PoseReading& reading) {
  for (const TextFormat& format : text_formats()) {
    if (reading.format ? format.name.name == *reading.format : format.match(text) == Match::kYes) {
      return format;
    }
  }
  throw_unknown(text);
}

/// Sorts the rows by time.
void sort_rows(PoseFile& file) {
  const auto earlier = [](const auto& a, const auto& b) { return a.stamp < b.stamp; };
  std::size_t late = 0;
  for (std::size_t i = 1; i < file.rows.size(); ++i) {
    late += earlier(file.rows[i], file.rows[i - 1]) ? 1 : 0;
  }
  if (late == 0) return;
  std::stable_sort(file.rows.begin(), file.rows.end(), earlier);
  file.notes.push_back(file.path.string() + ": " + counted_text(late, "row") +
                       " followed a later one; the rows were sorted by time.");
}

/// Refuses poses of one time that are far apart.
void check_times(const PoseFile& file) {
  constexpr double kFarthest = 0.2;  // Metres.
  for (std::size_t i = 1; i < file.rows.size(); ++i) {
    const PoseFile::Row &before = file.rows[i - 1], &row = file.rows[i];
    if (!row.stamp || *row.stamp != *before.stamp) continue;
    const double distance = (row.matrix.col(3) - before.matrix.col(3)).norm();
    if (!(distance > kFarthest)) continue;  // Also if a row has no pose (NaN).
    throw DataError(file.place(i) + ": time " + stamp_text(*row.stamp) + " s is that of line " +
                    std::to_string(before.line) + ", but the poses are " + number_text(distance) +
                    " m apart; expected one pose a time, or poses within 0.2 m. If times are equal "
                    "because they were written with too few digits, write them with all (nine "
                    "behind the point).");
  }
}

void check_format_name(const std::string& name) {
  std::vector<std::string> names;
  for (const PoseFormatName& known : pose_format_names()) names.push_back(known.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw UsageError("there is no pose format '" + name + "'." + suggestion(name, names));
}

/// Removes ":inverse" from the name of a format. @return whether it was there
bool take_inverse(std::optional<std::string>& format) {
  constexpr std::string_view kInverse = "inverse";
  if (!format || !format->ends_with(kInverse)) return false;
  format->resize(format->size() - kInverse.size());
  if (format->ends_with(':')) format->pop_back();
  if (format->empty()) format.reset();
  return true;
}

/// The inverse of a rigid motion. Another matrix stays invalid, so that `rigid_pose` reports it.
Eigen::Matrix<double, 3, 4> inverse_of(const Eigen::Matrix<double, 3, 4>& pose) {
  Eigen::Matrix<double, 3, 4> inverse;
  inverse.leftCols<3>() = pose.leftCols<3>().transpose();
  inverse.col(3) = -(inverse.leftCols<3>() * pose.col(3));
  return inverse;
}

}  // namespace

std::string PoseFile::place(std::size_t row) const {
  return path.string() + (is_binary ? ": pose " : ": line ") + std::to_string(rows[row].line);
}

std::vector<PoseFormatName> pose_format_names() {
  std::vector<PoseFormatName> names;
  for (const TextFormat& format : text_formats()) names.push_back(format.name);
  for (PoseFormatName& name : pose_formats::binary_format_names()) names.push_back(std::move(name));
  std::sort(names.begin(), names.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return names;
}

PoseFile read_pose_file(const std::filesystem::path& path, const PoseReading& asked) {
  PoseReading reading = asked;
  const bool inverse = take_inverse(reading.format);
  if (reading.format) check_format_name(*reading.format);
  auto binary = pose_formats::read_binary_poses(path, reading);
  if (!binary) {
    std::string content = read_text(path);
    const bool of_sensor = content.ends_with(kSensorPoses);
    const PoseText text(path, std::move(content));
    const TextFormat& format = format_of(text, reading);
    binary = format.read(text);
    binary->format = format.name.name;
    binary->of_sensor = of_sensor;
  }
  PoseFile& file = *binary;
  if (file.rows.empty()) {
    throw DataError(path.string() + ": holds no pose; expected one a row. " + kList);
  }
  const bool any = std::any_of(file.rows.begin(), file.rows.end(),
                               [](const PoseFile::Row& row) { return row.has_pose(); });
  if (!any) (void)rigid_pose(file, 0);  // Throws: the pose is not finite.
  if (file.stamped()) sort_rows(file);
  check_times(file);
  for (PoseFile::Row& row : file.rows) {
    if (inverse) row.matrix = inverse_of(row.matrix);
  }
  return std::move(file);
}

Pose rigid_pose(const PoseFile& file, std::size_t row) {
  return rigid_pose(file.rows[row].matrix, file.place(row));
}

namespace {

/// Extrapolates the motion from `a` to `b` to `stamp`.
StampedPose continued(const StampedPose& a, const StampedPose& b, Nanoseconds stamp) {
  const double share =
      static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return {stamp, a.T_world_body * part_of(a.T_world_body.inverse() * b.T_world_body, share)};
}

/// Extrapolates poses for the first and last rows if they have none and the next pose is near in
/// time. Else the scans at the ends would be lost.
void continue_ends(const PoseFile& file, std::vector<StampedPose>& poses) {
  constexpr Nanoseconds kNear = 200'000'000;
  if (poses.size() < 2) return;
  const Nanoseconds first = *file.rows.front().stamp, last = *file.rows.back().stamp;
  const std::size_t n = poses.size();
  if (last > poses[n - 1].stamp && last - poses[n - 1].stamp <= kNear &&
      poses[n - 1].stamp - poses[n - 2].stamp <= kNear) {
    poses.push_back(continued(poses[n - 2], poses[n - 1], last));
  }
  if (first < poses[0].stamp && poses[0].stamp - first <= kNear &&
      poses[1].stamp - poses[0].stamp <= kNear) {
    poses.insert(poses.begin(), continued(poses[0], poses[1], first));
  }
}

}  // namespace

std::vector<StampedPose> stamped_poses(const PoseFile& file, std::vector<std::string>& notes) {
  std::vector<StampedPose> poses;
  std::size_t none = 0, equal = 0, same = 1;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    if (!file.rows[i].has_pose()) {
      ++none;
      continue;
    }
    const StampedPose pose{*file.rows[i].stamp, rigid_pose(file, i)};
    const bool again = !poses.empty() && poses.back().stamp == pose.stamp;
    same = again ? same + 1 : 1;
    if (!again) {
      poses.push_back(pose);
      continue;
    }
    ++equal;
    poses.back().T_world_body =
        interpolated(poses.back().T_world_body, pose.T_world_body, 1.0 / static_cast<double>(same));
  }
  continue_ends(file, poses);
  const auto note = [&](std::size_t count, const char* what) {
    if (count == 0) return;
    notes.push_back(file.path.string() + ": " + grouped_text(count) + " of " +
                    counted_text(file.rows.size(), "row") + what);
  };
  note(none, " hold nan or zeros in place of a pose and are not used.");
  note(equal, " have the time of the row before; the poses of one time are averaged.");
  return poses;
}

}  // namespace raymoval
