// SPDX-License-Identifier: MIT
#include "datasets/clouds/file_source.h"

#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/returns.h"

namespace raymoval {
namespace {

const FrameEntry& frame_of(const std::vector<FrameEntry>& frames, std::size_t index) {
  if (index >= frames.size()) {
    throw InternalError("scan " + std::to_string(index) + " of a sequence of " +
                        std::to_string(frames.size()));
  }
  return frames[index];
}

}  // namespace

std::vector<std::uint32_t> of_kept_points(const Scan& scan, std::vector<std::uint32_t> stored) {
  if (scan.stored_index.empty() && !scan.points.empty()) return stored;
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
    const auto add = [&](std::size_t scan) {
      scans.push_back(load(scan));
      return !scans.back().points.empty();
    };
    bool any = false;
    for (const std::size_t scan : evenly_spread(scan_count, 5)) any = add(scan) || any;
    for (std::size_t scan = 0; !any && scan < scan_count; ++scan) any = add(scan);
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
  const ReturnCounts counts =
      read_returns(scan, traits_.point_frame, place(index), [&](const Eigen::Vector3d& origin) {
        Cloud cloud = read_cloud(frame.path, origin, traits_.reading);
        if (!traits_.has_reflectance) cloud.intensity.clear();
        return cloud;
      });
  tally_.set(index, counts.stored, counts.no_returns);
  return scan;
}

Pose FileScanSource::pose(std::size_t index) const {
  return frame_of(frames_, index).T_world_sensor;
}

PointRecords FileScanSource::records(std::size_t index) const {
  return read_records(frame_of(frames_, index).path, traits_.reading);
}

RecordLayout FileScanSource::layout(std::size_t index) const {
  return read_layout(frame_of(frames_, index).path, traits_.reading);
}

std::string FileScanSource::place(std::size_t index) const {
  return frame_of(frames_, index).path.string();
}

const SensorModel& FileScanSource::sensor() const {
  return sensor_.get(size(), [this](std::size_t index) { return load(index); });
}

std::vector<std::uint32_t> LabelFileSource::labels(const Scan& scan) const {
  const FrameEntry& frame = frame_of(frames_, scan.index);
  if (frame.label_path.empty()) return std::vector<std::uint32_t>(scan.size(), kNoLabelFile);
  const auto bytes = read_bytes(frame.label_path);
  if (bytes.size() != scan.stored_point_count * sizeof(std::uint32_t)) {
    throw DataError(frame.label_path.string() + ": holds " +
                    grouped_text(bytes.size() / sizeof(std::uint32_t)) + " labels (" +
                    grouped_text(bytes.size()) + " bytes, 4 a label), but " + frame.path.string() +
                    " holds " + grouped_text(scan.stored_point_count) +
                    " points; expected one label a point. Copy both again, or move the label file "
                    "away: scans without one are not scored.");
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
                      ", which is not a label (a whole number from 0 to 16,777,215). If intensity "
                      "is the strength of the return here, leave the label rule out.");
    }
    words.push_back(static_cast<std::uint32_t>(value));
  }
  return words;
}

}  // namespace raymoval
