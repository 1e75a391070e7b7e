// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval::toy {

/// The pose of a sensor at (x, y, z) whose axes are the world's.
inline Pose pose_at(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

/// Scans held in memory.
class HeldScans : public ScanSource {
 public:
  explicit HeldScans(const SensorModel& sensor = {}) : sensor_(sensor) {}

  /// @param points sensor frame, metres
  void add(std::vector<Eigen::Vector3f> points, const Pose& T_world_sensor = Pose::Identity()) {
    Scan scan;
    scan.name = std::to_string(scans_.size());
    scan.time_s = 0.1 * static_cast<double>(scans_.size());
    scan.T_world_sensor = T_world_sensor;
    scan.points = std::move(points);
    add_scan(std::move(scan));
  }
  /// Adds a scan unchanged except for its index.
  void add_scan(Scan scan) {
    scan.index = scans_.size();
    scan.stored_point_count = scan.points.size();
    scans_.push_back(std::move(scan));
  }
  /// @param world points in world coordinates; the sensor frame's single precision rounds them
  void add_world(const Pose& T_world_sensor, const std::vector<Eigen::Vector3d>& world) {
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Vector3d& point : world) {
      points.emplace_back((T_world_sensor.inverse() * point).cast<float>());
    }
    add(std::move(points), T_world_sensor);
  }
  /// The same from a sensor at `position`, whose axes are the world's.
  void add_world(const Eigen::Vector3d& position, const std::vector<Eigen::Vector3d>& world) {
    add_world(Pose(Eigen::Translation3d(position)), world);
  }

  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t i) const override { return scans_.at(i); }
  [[nodiscard]] Pose pose(std::size_t i) const override { return scans_.at(i).T_world_sensor; }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }
  [[nodiscard]] const std::vector<Scan>& scans() const { return scans_; }

 protected:
  std::vector<Scan> scans_;

 private:
  SensorModel sensor_;
};

/// The scans of another source, each of which is changed.
class ChangedScans : public DerivedSource {
 public:
  using Change = std::function<void(Scan&)>;
  ChangedScans(std::shared_ptr<const ScanSource> scans, Change change)
      : DerivedSource(std::move(scans)), change_(std::move(change)) {}
  /// @param scans must outlive this object
  ChangedScans(const ScanSource& scans, Change change)
      : ChangedScans({std::shared_ptr<void>(), &scans}, std::move(change)) {}

  [[nodiscard]] Scan load(std::size_t i) const override {
    Scan scan = whole_->load(i);
    change_(scan);
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t i) const override {
    Scan without_points;
    without_points.index = i;
    without_points.T_world_sensor = whole_->pose(i);
    change_(without_points);
    return without_points.T_world_sensor;
  }

 private:
  Change change_;
};

/// Points of all scans.
inline std::size_t point_count(const HeldScans& world) {
  std::size_t points = 0;
  for (const Scan& scan : world.scans()) points += scan.size();
  return points;
}

}  // namespace raymoval::toy
