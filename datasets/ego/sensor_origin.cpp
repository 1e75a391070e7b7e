// SPDX-License-Identifier: MIT
#include "datasets/ego/sensor_origin.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/returns.h"

namespace raymoval {

/// Largest distance along an axis, metres: no vehicle is larger.
static constexpr double kFarthestSensorOrigin = 100.0;

Eigen::Vector3d parse_sensor_origin(const std::string& text) {
  const auto numbers = parse_numbers(text, ',');
  if (numbers && numbers->size() == 3) {
    const Eigen::Vector3d origin = Eigen::Map<const Eigen::Vector3d>(numbers->data());
    if (origin.cwiseAbs().maxCoeff() <= kFarthestSensorOrigin) return origin;
  }
  throw UsageError(text +
                   ": expected X,Y,Z, the position of the sensor in the frame of the points, " +
                   "up to " + number_text(kFarthestSensorOrigin) + " m, such as 1.2,0,1.8.");
}

std::string sensor_origin_text(const Eigen::Vector3d& origin) {
  return number_text(origin.x()) + "," + number_text(origin.y()) + "," + number_text(origin.z());
}

SensorOriginSource::SensorOriginSource(std::shared_ptr<const ScanSource> whole,
                                       const Eigen::Vector3d& origin)
    : whole_(std::move(whole)), origin_(origin), sensor_(std::nullopt) {}

Pose SensorOriginSource::pose(std::size_t index) const {
  return whole_->pose(index) * Eigen::Translation3d(origin_);
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
    const Eigen::Vector3d moved = scan.points[i].cast<double>() - origin_;
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
