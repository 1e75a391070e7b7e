// SPDX-License-Identifier: MIT
#include "datasets/clouds/file_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/frames.h"

namespace raymoval {
namespace {

/// Share of infinite coordinates above which a scan is taken for damaged (evaluation protocol, edge
/// cases). NaN is no damage: drivers write it where nothing came back.
constexpr double kMostInfinite = 0.01;
/// No LiDAR measures nearer than this many metres: a point there stands for a missing return.
constexpr float kAtSensor = 0.05F;
/// The same at the origin of stored points in the world frame, where the sensor hardly ever stands.
constexpr float kAtZero = 1e-3F;

const FrameEntry& frame_of(const std::vector<FrameEntry>& frames, std::size_t index) {
  if (index >= frames.size()) {
    throw InternalError("scan " + std::to_string(index) + " of a sequence of " +
                        std::to_string(frames.size()));
  }
  return frames[index];
}

/// What a stored point is.
enum class PointKind { kReturn, kNoReturn, kInfinite };

PointKind kind_of(const Eigen::Vector3f& stored, float nearest) {
  if (stored.hasNaN()) return PointKind::kNoReturn;
  if (!stored.allFinite()) return PointKind::kInfinite;
  return stored.squaredNorm() < nearest * nearest ? PointKind::kNoReturn : PointKind::kReturn;
}

struct KindCounts {
  std::size_t stored = 0, no_returns = 0, infinite = 0;
  [[nodiscard]] std::size_t returns() const { return stored - no_returns - infinite; }
};

void check_kinds(const KindCounts& counts, const std::filesystem::path& path) {
  const std::string remedy = " Copy it again, or leave it out with --frames.";
  if (counts.stored == 0) {
    throw DataError(path.string() + ": holds no point; a scan has at least one." + remedy);
  }
  const double infinite = static_cast<double>(counts.infinite) / static_cast<double>(counts.stored);
  if (infinite > kMostInfinite) {
    throw DataError(path.string() + ": " + grouped_text(counts.infinite) + " of " +
                    grouped_text(counts.stored) +
                    " points are infinite, more than 1 %; the file looks damaged. Where nothing "
                    "came back write NaN." +
                    remedy);
  }
  if (counts.returns() == 0) {
    throw DataError(path.string() + ": none of its " + grouped_text(counts.stored) +
                    " points is a return (all are NaN or at the origin); a scan has at least one." +
                    remedy);
  }
}

/// Fills points, reflectance and stored_index with the returns among the points of `cloud`.
/// @param nearest what is stored nearer to the origin is no return, metres
KindCounts keep_returns(Cloud&& cloud, float nearest, Scan& scan) {
  KindCounts counts;
  counts.stored = scan.stored_point_count = cloud.points.size();
  for (const Eigen::Vector3f& point : cloud.points) {
    const PointKind kind = kind_of(point, nearest);
    counts.no_returns += kind == PointKind::kNoReturn ? 1 : 0;
    counts.infinite += kind == PointKind::kInfinite ? 1 : 0;
  }
  if (counts.returns() == counts.stored) {
    scan.points = std::move(cloud.points);
    scan.reflectance = std::move(cloud.intensity);
    return counts;
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (kind_of(cloud.points[i], nearest) != PointKind::kReturn) continue;
    scan.points.push_back(cloud.points[i]);
    if (!cloud.intensity.empty()) scan.reflectance.push_back(cloud.intensity[i]);
    scan.stored_index.push_back(static_cast<std::uint32_t>(i));
  }
  return counts;
}

/// Takes the returns among `points` from the world to the sensor; others stay as they are stored.
/// @param origin what was taken off the points when they were read
void bring_to_sensor(const Pose& T_sensor_world, const Eigen::Vector3d& origin,
                     std::vector<Eigen::Vector3f>& points) {
  const Eigen::Vector3f zero = (-origin).cast<float>();  // Where a stored zero is now.
  for (Eigen::Vector3f& point : points) {
    const Eigen::Vector3f stored = point - zero;
    const bool is_return = kind_of(stored, kAtZero) == PointKind::kReturn;
    point = is_return ? (T_sensor_world * point.cast<double>()).cast<float>() : stored;
  }
}

}  // namespace

std::vector<std::uint32_t> of_kept_points(const Scan& scan, std::vector<std::uint32_t> stored) {
  if (scan.stored_index.empty()) return stored;
  std::vector<std::uint32_t> words;
  words.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) words.push_back(stored[scan.stored_position(i)]);
  return words;
}

SensorChoice::SensorChoice(const std::optional<std::string>& name) {
  if (name && *name != "estimated") model_ = sensor_model_named(*name);
}

const SensorModel& SensorChoice::get(std::size_t scan_count, const Load& load) const {
  std::call_once(once_, [&] {
    if (model_) return;
    std::vector<Scan> scans;
    for (const std::size_t scan : evenly_spread(scan_count, 5)) scans.push_back(load(scan));
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
  if (in_world) bring_to_sensor(T_world_sensor.inverse(), origin, cloud.points);
  const KindCounts counts = keep_returns(std::move(cloud), kAtSensor, scan);
  check_kinds(counts, frame.path);
  tally_.set(index, counts.stored, counts.no_returns);
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
  return of_kept_points(scan, std::move(stored));
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
  std::vector<std::uint32_t> words;
  words.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::size_t position = scan.stored_position(i);
    const float value = cloud.intensity[position];
    if (!(value >= 0.0F && value < kExactLimit) || value != std::floor(value)) {
      throw DataError(frame.path.string() + ": point " + grouped_text(position) +
                      " has intensity " + number_text(static_cast<double>(value)) +
                      ", which is no label (a whole number from 0 to 16,777,215). If intensity is "
                      "the strength of the return here, leave the label rule out.");
    }
    words.push_back(static_cast<std::uint32_t>(value));
  }
  return words;
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
