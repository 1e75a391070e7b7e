// SPDX-License-Identifier: MIT
#include "datasets/file_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/files.h"
#include "core/local_frame.h"
#include "core/text.h"
#include "datasets/cloud_file.h"
#include "datasets/frames.h"

namespace raymoval {
namespace {

/// Share of non-finite points above which a scan is taken for damaged.
constexpr double kMostNonFinite = 0.01;

const FrameEntry& frame_of(const std::vector<FrameEntry>& frames, std::size_t index) {
  if (index >= frames.size()) {
    throw InternalError("scan " + std::to_string(index) + " of a sequence of " +
                        std::to_string(frames.size()));
  }
  return frames[index];
}

/// Fills points, reflectance and stored_index with the finite points of `cloud`.
void keep_finite(Cloud&& cloud, Scan& scan) {
  scan.stored_point_count = cloud.points.size();
  const auto finite = [](const Eigen::Vector3f& point) { return point.allFinite(); };
  if (std::all_of(cloud.points.begin(), cloud.points.end(), finite)) {
    scan.points = std::move(cloud.points);
    scan.reflectance = std::move(cloud.intensity);
    return;
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!finite(cloud.points[i])) continue;
    scan.points.push_back(cloud.points[i]);
    if (!cloud.intensity.empty()) scan.reflectance.push_back(cloud.intensity[i]);
    scan.stored_index.push_back(static_cast<std::uint32_t>(i));
  }
}

void check_counts(const Scan& scan, const std::filesystem::path& path) {
  const std::string remedy = " Copy it again, or leave it out with --frames.";
  if (scan.stored_point_count == 0) {
    throw DataError(path.string() + ": holds no point; a scan has at least one." + remedy);
  }
  const double share =
      static_cast<double>(scan.non_finite_count()) / static_cast<double>(scan.stored_point_count);
  if (share > kMostNonFinite) {
    throw DataError(path.string() + ": " + grouped_text(scan.non_finite_count()) + " of " +
                    grouped_text(scan.stored_point_count) +
                    " points are not finite (nan or inf), more than 1 %; the file looks damaged." +
                    remedy);
  }
}

/// Label words of the points that were kept.
std::vector<std::uint32_t> of_kept_points(const Scan& scan,
                                          const std::vector<std::uint32_t>& stored) {
  if (scan.stored_index.empty()) return stored;
  std::vector<std::uint32_t> words;
  words.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) words.push_back(stored[scan.stored_position(i)]);
  return words;
}

}  // namespace

SensorChoice::SensorChoice(const std::optional<std::string>& name) {
  if (name && *name != "estimated") model_ = sensor_model_named(*name);
}

const SensorModel& SensorChoice::get(std::size_t scan_count, const Load& load) const {
  std::call_once(once_, [&] {
    if (model_) return;
    const std::size_t samples = std::min<std::size_t>(scan_count, 5);
    std::vector<Scan> scans;
    for (std::size_t i = 0; i < samples; ++i) {
      scans.push_back(load(samples == 1 ? 0 : i * (scan_count - 1) / (samples - 1)));
    }
    model_ = estimate_sensor_model(scans);
  });
  return *model_;
}

Scan FileScanSource::load(std::size_t index) const {
  const FrameEntry& frame = frame_of(frames_, index);
  Scan scan;
  scan.index = index;
  scan.name = frame.name;
  scan.time_s = frame.time_s;
  scan.T_world_sensor = frame.T_world_sensor;
  const bool in_world = traits_.point_frame == PointFrame::kWorld;
  // Points of a far world are read from the sensor's position on, before they become float32.
  Pose T_world_sensor = frame.T_world_sensor;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (in_world && T_world_sensor.translation().cwiseAbs().maxCoeff() > kFarFromOrigin) {
    origin = T_world_sensor.translation();
    T_world_sensor.translation().setZero();
  }
  Cloud cloud = read_cloud(frame.path, origin);
  if (!traits_.has_reflectance) cloud.intensity.clear();
  if (in_world) {
    const Pose T_sensor_world = T_world_sensor.inverse();
    for (Eigen::Vector3f& point : cloud.points) {
      point = (T_sensor_world * point.cast<double>()).cast<float>();
    }
  }
  keep_finite(std::move(cloud), scan);
  check_counts(scan, frame.path);
  return scan;
}

Pose FileScanSource::pose(std::size_t index) const {
  return frame_of(frames_, index).T_world_sensor;
}

const SensorModel& FileScanSource::sensor() const {
  return sensor_.get(size(), [this](std::size_t index) { return load(index); });
}

std::vector<std::uint32_t> LabelFileSource::labels(const Scan& scan) const {
  const FrameEntry& frame = frame_of(frames_, scan.index);
  const auto bytes = read_bytes(frame.label_path);
  if (bytes.size() != scan.stored_point_count * sizeof(std::uint32_t)) {
    throw DataError(frame.label_path.string() + ": holds " +
                    grouped_text(bytes.size() / sizeof(std::uint32_t)) + " labels (" +
                    grouped_text(bytes.size()) + " bytes, 4 a label), but " + frame.path.string() +
                    " holds " + grouped_text(scan.stored_point_count) +
                    " points; expected one label a point. Copy both again, or leave the frame out "
                    "with --frames.");
  }
  std::vector<std::uint32_t> stored(scan.stored_point_count);
  if (!bytes.empty()) std::memcpy(stored.data(), bytes.data(), bytes.size());
  return of_kept_points(scan, stored);
}

std::vector<std::uint32_t> IntensityLabelSource::labels(const Scan& scan) const {
  constexpr float kExactLimit = 16777216.0F;
  const FrameEntry& frame = frame_of(frames_, scan.index);
  const Cloud cloud = read_cloud(frame.path);
  if (cloud.intensity.size() != scan.stored_point_count) {
    throw DataError(frame.path.string() + ": holds " + grouped_text(cloud.intensity.size()) +
                    " intensities for " + grouped_text(scan.stored_point_count) +
                    " points; a label rule was given, so each point's intensity has to be its "
                    "label.");
  }
  std::vector<std::uint32_t> stored;
  stored.reserve(cloud.intensity.size());
  for (const float value : cloud.intensity) {
    if (!(value >= 0.0F && value < kExactLimit) || value != std::floor(value)) {
      throw DataError(frame.path.string() + ": point " + grouped_text(stored.size()) +
                      " has intensity " + number_text(static_cast<double>(value)) +
                      ", which is no label (a whole number from 0 to 16,777,215). If intensity is "
                      "the strength of the return here, leave the label rule out.");
    }
    stored.push_back(static_cast<std::uint32_t>(value));
  }
  return of_kept_points(scan, stored);
}

bool find_label_files(const std::filesystem::path& folder, std::vector<FrameEntry>& frames) {
  if (!has_folder(folder)) return false;
  for (FrameEntry& frame : frames) {
    frame.label_path = folder / (frame.name + ".label");
    if (!has_file(frame.label_path)) {
      throw DataError(frame.label_path.string() + ": is missing, but " + folder.string() +
                      " exists and " + frame.path.string() +
                      " is to be used. Copy the label file, leave the frame out with --frames, or "
                      "move the labels folder away to work without labels.");
    }
  }
  return true;
}

}  // namespace raymoval
