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

/// Those of names first: a line of names says more than a count of numbers.
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
  (void)text.numbers(row);  // What is no number says more than the count.
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

/// Times that are equal, or that run backwards, belong to no trajectory.
void check_times(const PoseFile& file) {
  for (std::size_t i = 1; i < file.rows.size(); ++i) {
    const auto &before = file.rows[i - 1].stamp, &stamp = file.rows[i].stamp;
    if (!stamp || *stamp > *before) continue;
    const bool same = *stamp == *before;
    throw DataError(file.place(i) + ": time " + stamp_text(*stamp) + " s is " +
                    (same ? "that of the row above" : "before that of the row above") +
                    "; expected times that increase." +
                    (same ? " If times are equal because they were written with too few digits, "
                            "write them with all (nine behind the point)."
                          : ""));
  }
}

void check_format_name(const std::string& name) {
  std::vector<std::string> names;
  for (const PoseFormatName& known : pose_format_names()) names.push_back(known.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw UsageError("there is no pose format '" + name + "'." + suggestion(name, names));
}

/// Takes ":inverse" off the name of a format. @return whether it was there
bool take_inverse(std::optional<std::string>& format) {
  constexpr std::string_view kInverse = "inverse";
  if (!format || !format->ends_with(kInverse)) return false;
  format->resize(format->size() - kInverse.size());
  if (format->ends_with(':')) format->pop_back();
  if (format->empty()) format.reset();
  return true;
}

/// Of a rigid motion. What is none stays none, for `rigid_pose` to say so.
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
    const PoseText text(path, read_text(path));
    const TextFormat& format = format_of(text, reading);
    binary = format.read(text);
    binary->format = format.name.name;
  }
  PoseFile& file = *binary;
  if (file.rows.empty()) {
    throw DataError(path.string() + ": holds no pose; expected one a row. " + kList);
  }
  check_times(file);
  for (PoseFile::Row& row : file.rows) {
    if (inverse) row.matrix = inverse_of(row.matrix);
  }
  return std::move(file);
}

Pose rigid_pose(const PoseFile& file, std::size_t row) {
  return rigid_pose(file.rows[row].matrix, file.place(row));
}

Trajectory trajectory_of(const PoseFile& file) {
  if (!file.stamped()) throw InternalError("a trajectory of poses without times");
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    poses.push_back({*file.rows[i].stamp, rigid_pose(file, i)});
  }
  return Trajectory(std::move(poses));
}

}  // namespace raymoval
