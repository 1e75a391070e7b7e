// SPDX-License-Identifier: MIT
#include "datasets/trajectories/body_sensor.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/poses.h"
#include "datasets/trajectories/pose_format.h"

namespace raymoval {
namespace {

constexpr const char* kForm =
    "expected x,y,z,qx,qy,qz,qw (the position of the sensor on the body in metres, and its "
    "attitude), or a file with these seven numbers or a 3 x 4 or 4 x 4 matrix";

/// The numbers between blanks, commas and line ends; empty if a word is no number.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r\n,;";
  constexpr std::size_t kMost = 16;
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const auto number = parse_number<double>(text.substr(at, end - at));
    if (!number || numbers.size() == kMost) return std::nullopt;
    numbers.push_back(*number);
    at = text.find_first_not_of(kBetween, end);
  }
  return numbers;
}

Pose pose_from(const std::vector<double>& numbers, const std::string& where) {
  using pose_formats::PoseColumns;
  using pose_formats::Rotation;
  PoseColumns columns;
  if (numbers.size() == 7) {
    columns.position = {0, 1, 2};
    columns.turn = {3, 4, 5, 6};
  } else if (numbers.size() == 12 || numbers.size() == 16) {
    columns.rotation = numbers.size() == 12 ? Rotation::kMatrix3x4 : Rotation::kMatrix4x4;
  } else {
    throw DataError(where + ": has " + std::to_string(numbers.size()) + " numbers; " + kForm + ".");
  }
  return rigid_pose(pose_formats::pose_matrix(numbers, columns, where), where);
}

/// The text of a file without its comments.
std::string without_comments(const std::string& text) {
  std::string rest;
  for (const std::string_view line : split(text, '\n')) {
    rest += std::string(line.substr(0, line.find('#'))) + "\n";
  }
  return rest;
}

}  // namespace

BodySensor read_body_sensor(const std::string& text, const std::filesystem::path& folder) {
  const auto typed = numbers_in(text);
  if (typed && typed->size() == 7) return {pose_from(*typed, "--T-sensor " + text), std::nullopt};
  const std::filesystem::path path =
      has_file(folder / text) ? folder / text : std::filesystem::path(text);
  if (!has_file(path)) {
    throw UsageError("--T-sensor " + text + ": is not a file and not seven numbers; " +
                     std::string(kForm) + ".");
  }
  const auto stored = numbers_in(without_comments(read_text(path)));
  if (!stored) {
    throw DataError(path.string() + ": holds something else than numbers, or more than 16; " +
                    std::string(kForm) + ".");
  }
  return {pose_from(*stored, path.string()), path};
}

}  // namespace raymoval
