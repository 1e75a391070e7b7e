// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/records/record_source.h"
#include "datasets/sequence.h"

namespace raymoval::test {

/// Scans in memory that are made of records: a point for each row, in the frame that is given.
class RecordedScans : public ScanSource, public RecordSource {
 public:
  RecordedScans(std::vector<PointRecords> scans, std::vector<Pose> poses,
                PointFrame frame = PointFrame::kSensor)
      : scans_(std::move(scans)), poses_(std::move(poses)), frame_(frame) {}

  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    const PointRecords& rows = scans_[index];
    const PositionFields at = position_fields(rows.layout, "a test");
    Scan scan;
    scan.index = index;
    scan.name = "scan" + std::to_string(index);
    scan.T_world_sensor = poses_[index];
    scan.stored_point_count = rows.size();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Vector3d stored(rows.value(i, at.x), rows.value(i, at.y), rows.value(i, at.z));
      const Eigen::Vector3d point =
          frame_ == PointFrame::kWorld ? scan.T_world_sensor.inverse() * stored : stored;
      scan.points.push_back(point.cast<float>());
    }
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override { return poses_[index]; }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }

  [[nodiscard]] PointRecords records(std::size_t index) const override { return scans_[index]; }
  [[nodiscard]] PointFrame point_frame() const override { return frame_; }
  [[nodiscard]] std::string place(std::size_t index) const override {
    return "scan" + std::to_string(index) + ".pcd";
  }

 private:
  std::vector<PointRecords> scans_;
  std::vector<Pose> poses_;
  PointFrame frame_;
  SensorModel sensor_;
};

inline Sequence sequence_of(const std::shared_ptr<RecordedScans>& scans) {
  Sequence sequence;
  sequence.name = "recorded";
  sequence.scans = scans;
  sequence.records = scans;
  return sequence;
}

/// A progress that shows nothing, and a flag that is never set.
inline Progress& no_progress() {
  static Progress progress(ProgressStyle::kQuiet);
  return progress;
}
inline const std::atomic<bool> kGoOn{false};

/// x y z as float32, then ring (uint16), time (float64) and a byte that means nothing.
inline RecordLayout driver_layout() {
  return parse_point_layout("x y z intensity ring:u2 time:f8 _:u1");
}

/// A row for each of `values`, whose numbers belong to the fields of `layout` in turn.
inline PointRecords records_of(const RecordLayout& layout,
                               const std::vector<std::vector<double>>& values) {
  PointRecords rows{layout, std::vector<std::byte>(values.size() * layout.row_bytes, std::byte{7}),
                    values.size(), 1};
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < values[i].size(); ++k) {
      rows.set_value(i, layout.fields[k], values[i][k]);
    }
  }
  return rows;
}

/// Field `name` of row `point`.
inline double value_of(const PointRecords& rows, std::size_t point, const std::string& name) {
  return rows.value(point, *rows.layout.find({name}));
}

}  // namespace raymoval::test
