// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval::toy {

/// Scans held in memory, each as it is given but for its position in the source.
class ScanList : public ScanSource {
 public:
  explicit ScanList(const SensorModel& sensor) : sensor_(sensor) {}

  void add(Scan scan) {
    scan.index = scans_.size();
    scan.stored_point_count = scan.points.size();
    scans_.push_back(std::move(scan));
  }
  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t i) const override { return scans_.at(i); }
  [[nodiscard]] Pose pose(std::size_t i) const override { return scans_.at(i).T_world_sensor; }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }
  [[nodiscard]] const std::vector<Scan>& scans() const { return scans_; }

 private:
  std::vector<Scan> scans_;
  SensorModel sensor_;
};

/// What a random world consists of.
struct WorldPlan {
  int scans = 0;
  int walls = 0;   ///< Standing boxes of any size.
  int movers = 0;  ///< Cars and people.
  unsigned seed = 0;
};

/// A number in [low, high), the same from every standard library.
double number_between(double low, double high, std::mt19937& random);

/// A road with standing and moving boxes, before a sensor that drives along it and sees 150 degrees
/// ahead in steps of 1.5 degrees, 21 rows, up to 25 m. Ranges are noisy by a centimetre and
/// directions by a tenth of a degree, so that no point lies on a wall of a lattice or on the border
/// of a pixel. One tick of 0.1 s is between scans.
ScanList random_world(const WorldPlan& plan);

}  // namespace raymoval::toy
