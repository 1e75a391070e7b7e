// SPDX-License-Identifier: MIT
#include "datasets/sequence_poses.h"

#include <Eigen/Geometry>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "datasets/deskew/deskew.h"
#include "datasets/odometry/estimate.h"
#include "datasets/registration/reposed_source.h"
#include "datasets/settings.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/scan_poses.h"

namespace raymoval {
namespace {

constexpr const char *kEstimate = "estimate", *kRefine = "refine";

void check_alone(const SequenceOptions& options) {
  const std::pair<bool, const char*> given[] = {
      {options.pose_format.has_value(), "--pose-format"},
      {options.T_sensor.has_value(), "--T-sensor"},
      {options.time_offset_s.has_value(), "--time-offset"},
      {options.max_gap_s.has_value(), "--max-gap"},
      {options.pose_topic.has_value(), "--pose-topic"}};
  for (const auto& [is_given, name] : given) {
    if (!is_given) continue;
    throw UsageError(std::string(name) +
                     " has no effect with --poses estimate, which reads no poses. Leave it out.");
  }
}

void check_can_move(const Sequence& sequence, const std::string& option) {
  if (!sequence.topics.empty()) {
    throw UsageError(option + ": sequence " + sequence.name +
                     " has scans of several topics. Estimate the poses of one --topic and write "
                     "them with --write-poses FILE; then read all topics with --poses FILE.");
  }
  if (sequence.records != nullptr && sequence.records->point_frame() == PointFrame::kWorld) {
    throw UsageError(option + ": the points of sequence " + sequence.name +
                     " are in the world frame, so their poses are already applied. Take the scans "
                     "in the sensor frame.");
  }
}

TimedScan timed(const Sequence& sequence, const ScanSource& scans, std::size_t i) {
  return {scans.load(i), sequence.records->records(i), sequence.stamps[i],
          sequence.records->place(i)};
}

/// The times of the points of a scan; null if points have no times.
std::function<std::vector<double>(const Scan&)> point_times_of(const Sequence& sequence) {
  const std::size_t count = sequence.scans->size();
  if (sequence.records == nullptr || sequence.stamps.size() != count || count == 0) return nullptr;
  if (sequence.records->layout(count / 2).find(time_names()) == nullptr) return nullptr;
  std::vector<TimedScan> some;
  for (const std::size_t i : std::set<std::size_t>{0, count / 2, count - 1}) {
    some.push_back(timed(sequence, *sequence.scans, i));
    if (some.back().scan.points.empty()) some.pop_back();
  }
  if (some.empty()) return nullptr;
  try {
    const PointClock clock = find_point_clock(some, sequence.point_time_unit);
    return [records = sequence.records, stamps = sequence.stamps, clock](const Scan& scan) {
      if (scan.points.empty()) return std::vector<double>();
      return point_times(
          {scan, records->records(scan.index), stamps[scan.index], records->place(scan.index)},
          clock);
    };
  } catch (const DataError&) {
    if (sequence.deskew) throw;
    return nullptr;  // All points of a scan have one time, for example.
  }
}

}  // namespace

PoseWork take_pose_work(SequenceOptions& options) {
  const std::string asked = options.poses.value_or("");
  if (asked == kEstimate) {
    check_alone(options);
    options.poses = kStationarySensor;
    return PoseWork::kEstimate;
  }
  const std::string prefix = std::string(kRefine) + ":";
  if (asked == kRefine) {
    options.poses.reset();
  } else if (asked.starts_with(prefix) && asked.size() > prefix.size()) {
    options.poses = asked.substr(prefix.size());
  } else {
    return PoseWork::kNone;
  }
  return PoseWork::kRefine;
}

void make_poses(Sequence& sequence, PoseWork work, const OpenContext& context) {
  if (work == PoseWork::kNone) return;
  const bool estimates = work == PoseWork::kEstimate;
  check_can_move(sequence, std::string("--poses ") + (estimates ? kEstimate : kRefine));
  const odometry::MovingScans input{*sequence.scans, point_times_of(sequence), {},
                                    context.threads, context.progress,         context.cancel};
  std::vector<Pose> given;
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) given.push_back(sequence.scans->pose(i));
  odometry::PoseEstimate made =
      estimates ? odometry::estimate_poses(input) : odometry::refine_poses(input, given);
  sequence.made_poses = std::move(made.poses);
  sequence.pose_doubts = std::move(made.doubts);
  sequence.scans = std::make_shared<ReposedSource>(sequence.scans, sequence.made_poses);
  if (!made.summary.empty()) sequence.notes.push_back(made.summary);
  sequence.notes.insert(sequence.notes.end(), made.warnings.begin(), made.warnings.end());
  sequence.poses_file = estimates ? kEstimate : kRefine + (":" + sequence.poses_file);
  sequence.T_body_sensor.reset();
  if (sequence.stamps.size() != sequence.made_poses.size()) return;
  std::vector<std::optional<Pose>> poses(sequence.made_poses.begin(), sequence.made_poses.end());
  sequence.motion = motion_along(sequence.stamps, poses);
}

std::string pose_file_text(const Sequence& sequence, const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const bool is_kitti = name.ends_with(".kitti") || name.ends_with("_kitti.txt");
  const ScanSource& stored = stored_source(sequence);
  std::string text;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const Pose pose = sequence.made_poses.empty() ? stored.pose(i) : sequence.made_poses[i];
    std::vector<std::string> words;
    if (is_kitti) {
      for (int k = 0; k < 12; ++k) words.push_back(number_text(pose.matrix()(k / 4, k % 4)));
    } else {
      words.push_back(sequence.stamps.size() == stored.size() ? stamp_text(sequence.stamps[i])
                                                              : number_text(stored.load(i).time_s));
      for (const double value : pose.translation()) words.push_back(number_text(value));
      const Eigen::Quaterniond turn(pose.linear());
      for (const double value : turn.coeffs()) words.push_back(number_text(value));
    }
    text += join(words, " ") + '\n';
  }
  return is_kitti ? text : text + kSensorPoses;
}

}  // namespace raymoval
