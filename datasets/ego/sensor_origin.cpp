// SPDX-License-Identifier: MIT
#include "datasets/ego/sensor_origin.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/returns.h"

namespace raymoval {

SensorOriginSource::SensorOriginSource(std::shared_ptr<const ScanSource> whole,
                                       std::vector<Eigen::Vector3d> origins)
    : DerivedSource(std::move(whole)), origins_(std::move(origins)), sensor_(std::nullopt) {}

Pose SensorOriginSource::pose(std::size_t index) const {
  return whole_->pose(index) * Eigen::Translation3d(origins_.at(index));
}

const SensorModel& SensorOriginSource::sensor() const {
  const SensorModel& model = whole_->sensor();
  if (model.name != "estimated") return model;
  return sensor_.get(size(), [this](std::size_t index) { return load(index); });
}

Scan SensorOriginSource::load(std::size_t index) const {
  Scan scan = whole_->load(index);
  std::vector<std::uint32_t> kept;
  kept.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d moved = scan.points[i].cast<double>() - origins_.at(index);
    scan.points[i] = moved.cast<float>();
    if (scan.points[i].squaredNorm() >= kAtSensor * kAtSensor) {
      kept.push_back(static_cast<std::uint32_t>(i));
    }
  }
  scan.T_world_sensor = pose(index);
  if (kept.empty() && scan.size() > 0) {
    throw DataError("scan " + scan.name + ": all of its " + counted_text(scan.size(), "point") +
                    " lie at the position that --sensor-origin gives, so none is a return.");
  }
  keep_points(scan, std::move(kept));
  return scan;
}

}  // namespace raymoval
