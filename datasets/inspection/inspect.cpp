// SPDX-License-Identifier: MIT
#include "datasets/inspection/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/same_file.h"
#include "core/text.h"
#include "datasets/bag_scans/bag_source.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/frames.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/layouts.h"
#include "datasets/settings.h"
#include "datasets/trajectories/pose_file.h"

namespace raymoval {

namespace {

/// Fills in the defaults of the check.
Finding completed(Finding finding, const InspectionCheck& check,
                  const inspection::Samples& samples) {
  if (finding.check.empty()) finding.check = check.name;
  if (finding.expected.empty()) finding.expected = check.expected;
  if (finding.remedy.empty()) finding.remedy = check.remedy;
  finding.consequence = check.consequence;
  if (finding.where.empty()) finding.where = samples.pose_source() + ", " + samples.all_frames();
  return finding;
}

/// Tells how to read all topics with clouds, if there are several.
void add_other_topics(const Bag& bag, std::vector<std::string>& notes) {
  std::vector<std::string> names;
  for (const BagTopic& topic : bag.topics()) {
    if (has_points(topic.type) && topic.messages > 0) names.push_back(topic.name);
  }
  if (names.size() < 2) return;
  notes.push_back("If these topics are of several sensors of one vehicle, --topic " +
                  join(names, ",") + " reads their scans together.");
}

}  // namespace

const std::vector<InspectionCheck>& inspection_checks() {
  using namespace inspection;
  static const std::vector<Check> checks = [] {
    std::vector<Check> all;
    for (const auto& part : {recording_checks(), reach_checks(), point_checks(), pose_checks(),
                             time_checks(), label_checks(), ego_checks(), sensor_model_checks(),
                             skew_checks(), world_checks(), origin_checks(), fit_checks()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return checks;
}

const InspectionCheck& inspection::check_named(const std::string& name) {
  for (const InspectionCheck& check : inspection_checks()) {
    if (check.name == name) return check;
  }
  throw InternalError("no check is called " + name);
}

InspectionReport inspect(const Sequence& sequence, int threads, const std::atomic<bool>* cancel) {
  inspection::Samples samples(sequence, threads, cancel);
  InspectionReport report;
  report.sequence = sequence.name;
  report.layout = sequence.layout;
  report.scans = samples.size();
  report.scans_read = samples.scans().size();
  for (const InspectionCheck& check : inspection_checks()) {
    throw_if_cancelled(cancel);
    for (Finding& finding : check.look(samples)) {
      report.findings.push_back(completed(std::move(finding), check, samples));
    }
  }
  report.notes = sequence.notes;  // The checks report its damage.
  report.notes.insert(report.notes.end(), sequence.losses.begin(), sequence.losses.end());
  if (const auto* scans = dynamic_cast<const BagScanSource*>(&stored_source(sequence))) {
    report.notes.push_back(bag_name(scans->bag()) + ": " + topics_sentence(scans->bag()));
    if (sequence.topics.empty()) add_other_topics(scans->bag(), report.notes);
  }
  report.sensor = inspection::sensor_text(samples);
  if (inspection::can_measure_fit(samples)) report.pose_fit = inspection::pose_fit_text(samples);
  report.measures = std::move(samples.measures);
  return report;
}

namespace {

namespace fs = std::filesystem;

/// Pose files of `folder` with a number of poses that would fit.
std::vector<std::string> fitting_files(const fs::path& folder, std::size_t least,
                                       std::size_t most) {
  std::vector<std::string> names;
  for (const auto& path : list_files(folder, {".txt"})) {
    try {
      const std::size_t rows = read_pose_file(path).rows.size();
      if (rows >= least && rows <= most) names.push_back(path.filename().string());
    } catch (const UnreadableError&) {
      throw;
    } catch (const Error&) {
      continue;  // Not a pose file.
    }
  }
  return names;
}

Finding count_finding(const fs::path& poses, std::size_t rows, const fs::path& folder,
                      std::size_t least, std::size_t most) {
  const auto others = fitting_files(folder, least, most);
  return {.check = "poses-of-another-sequence",
          .where = poses.filename().string(),
          .what = "holds " + counted_text(rows, "pose") + " for " + counted_text(least, "scan"),
          .expected = "one pose a scan",
          .remedy =
              others.empty()
                  ? "Take the pose file that belongs to these scans (--poses FILE)."
                  : fmt::format("The count of {} fits: --poses {}.", join(others), others.front())};
}

/// Compares the number of poses with the number of scans.
std::vector<Finding> check_count(const fs::path& folder, const Layout& layout,
                                 const SequenceOptions& options) {
  const auto settings = read_settings(folder, options, {});
  if (settings.poses == kStationarySensor) return {};
  const auto path = find_pose_file(folder, settings.poses.value_or("poses.txt"));
  const PoseFile file = read_pose_file(path, {settings.pose_format});
  // Poses with times, and one pose for all scans, need not match the number of scans.
  if (file.stamped() || file.rows.size() == 1 || file.rows.front().frame) return {};
  const std::size_t rows = file.rows.size();
  std::size_t least = 0, most = SIZE_MAX;
  if (layout.pose_place == PosePlace::kRowOfFrameNumber) {
    const auto files = list_numbered_files(folder / layout.scan_folder, ".bin");
    least = static_cast<std::size_t>(files.back().number) + 1;
  } else {
    const auto files = list_files(folder / layout.scan_folder, cloud_extensions());
    // Poses may be in an array or a cloud file, which is no scan.
    least = most = static_cast<std::size_t>(
        std::count_if(files.begin(), files.end(),
                      [&](const fs::path& scan) { return !is_same_file(scan, path); }));
  }
  if (least == 0 || (rows >= least && rows <= most)) return {};
  return {count_finding(path, rows, folder, least, most)};
}

/// Finds scan files that lack their pose.
std::vector<Finding> check_viewpoints(const fs::path& folder, const Layout& layout) {
  constexpr std::size_t kHead = 65536;
  for (const auto& path : list_files(folder / layout.scan_folder, {".pcd"})) {
    if (parse_pcd_header(read_piece(path, 0, kHead), path).viewpoint) continue;
    return {{.check = "viewpoint-missing",
             .where = layout.scan_folder + "/" + path.filename().string(),
             .what = "the header has no VIEWPOINT",
             .expected = "VIEWPOINT tx ty tz qw qx qy qz, the pose of the sensor",
             .remedy = "Add the line, with points in the world frame; or put the scans (in the "
                       "sensor frame) beside a pose file."}};
  }
  return {};
}

}  // namespace

std::vector<Finding> unopenable_findings(const std::string& path, const SequenceOptions& options) {
  try {
    const Layout* layout = recognised_layout(path);
    if (layout == nullptr || layout->pose_place == PosePlace::kOther) return {};
    const fs::path folder = layout->folder_of ? layout->folder_of(path) : fs::path(path);
    if (!is_folder(folder)) return {};
    if (layout->pose_place == PosePlace::kScanFile) return check_viewpoints(folder, *layout);
    return check_count(folder, *layout, options);
  } catch (const UnreadableError&) {
    throw;  // Neither damaged nor absent.
  } catch (const Error&) {
    return {};  // Opening the sequence reports the error.
  }
}

InspectionReport inspect_path(const std::string& path, const SequenceOptions& options,
                              const OpenContext& context,
                              const std::function<void(const Sequence&)>& opened) {
  InspectionReport report;
  report.sequence = std::filesystem::path(path).filename().string();
  report.findings = unopenable_findings(path, options);
  if (!report.findings.empty()) return report;
  std::optional<Sequence> sequence;
  try {
    sequence = open_sequence(path, options, context);
  } catch (const PosesMissing& error) {
    report.findings.push_back(
        {.check = inspection::kMissingPoses,
         .where = error.gap().where,
         .what = error.gap().what,
         .expected = inspection::check_named(inspection::kMissingPoses).expected,
         .remedy = error.gap().remedy});
    return report;
  }
  if (opened) opened(*sequence);
  return inspect(*sequence, context.threads, context.cancel);
}

}  // namespace raymoval
