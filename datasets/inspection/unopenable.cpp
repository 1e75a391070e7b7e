// SPDX-License-Identifier: MIT
#include "datasets/inspection/unopenable.h"

#include <algorithm>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/cloud_header.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/poses.h"
#include "datasets/settings.h"

namespace raymoval::inspection {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& path) {
  const std::size_t colon = path.rfind(':');
  if (is_folder(path) || colon == std::string::npos) return path;
  std::string selection = path.substr(colon + 1);
  if (selection.starts_with("kitti-")) selection = selection.substr(6);
  return fs::path(path.substr(0, colon)) / "sequences" / selection;
}

/// Pose files of `folder` whose count would fit.
std::vector<std::string> fitting_files(const fs::path& folder, std::size_t least,
                                       std::size_t most) {
  std::vector<std::string> names;
  for (const auto& path : list_files(folder, {".txt"})) {
    try {
      const std::size_t rows = read_pose_file(path).rows.size();
      if (rows >= least && rows <= most) names.push_back(path.filename().string());
    } catch (const Error&) {
      continue;  // Not a pose file.
    }
  }
  return names;
}

Finding count_finding(const fs::path& poses, std::size_t rows, const fs::path& folder,
                      std::size_t least, std::size_t most) {
  Finding finding;
  finding.check = "poses-of-another-sequence";
  finding.where = poses.filename().string();
  finding.what = "holds " + counted_text(rows, "pose") + " for " + counted_text(least, "scan");
  finding.expected = "one pose a scan";
  const auto others = fitting_files(folder, least, most);
  finding.remedy = others.empty()
                       ? "Take the pose file that belongs to these scans (--poses FILE)."
                       : "The count of " + join(others) + " fits: --poses " + others.front() + ".";
  return finding;
}

/// The pose file's count against that of the scans.
std::vector<Finding> check_count(const fs::path& folder, const SequenceOptions& options) {
  const bool kitti = has_folder(folder / "velodyne");
  const auto settings = read_settings(folder, options, {});
  const auto path = find_pose_file(folder, settings.poses.value_or("poses.txt"));
  const std::size_t rows = read_pose_file(path).rows.size();
  std::size_t least = 0, most = SIZE_MAX;
  if (kitti) {
    const auto files = list_numbered_files(folder / "velodyne", ".bin");
    least = static_cast<std::size_t>(files.back().number) + 1;
  } else {
    least = most = list_files(folder, cloud_extensions()).size();
  }
  if (least == 0 || (rows >= least && rows <= most)) return {};
  return {count_finding(path, rows, folder, least, most)};
}

/// .pcd files of the DynamicMap layout without their pose.
std::vector<Finding> check_viewpoints(const fs::path& folder) {
  constexpr std::size_t kHead = 65536;
  for (const auto& path : list_files(folder / "pcd", {".pcd"})) {
    if (parse_pcd_header(read_piece(path, 0, kHead), path).viewpoint) continue;
    Finding finding;
    finding.check = "viewpoint-missing";
    finding.where = "pcd/" + path.filename().string();
    finding.what = "the header has no VIEWPOINT";
    finding.expected = "VIEWPOINT tx ty tz qw qx qy qz, the pose of the sensor";
    finding.remedy =
        "Add the line, with points in the world frame; or put the scans (in the "
        "sensor frame) beside a pose file.";
    return {finding};
  }
  return {};
}

}  // namespace

std::vector<Finding> unopenable_findings(const std::string& path, const SequenceOptions& options) {
  try {
    const fs::path folder = folder_of(path);
    if (!is_folder(folder)) return {};
    if (is_folder(folder / "pcd") && !is_folder(folder / "velodyne")) {
      return check_viewpoints(folder);
    }
    return check_count(folder, options);
  } catch (const Error&) {
    return {};  // Whoever opens the sequence says what is wrong.
  }
}

}  // namespace raymoval::inspection
