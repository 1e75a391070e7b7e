// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/scan/scan_source.h"
#include "datasets/clouds/file_source.h"

namespace raymoval {

/// Shifts scans of another source from the frame of a vehicle to the sensor: the origin of a scan
/// is subtracted from its points, and T_world_sensor is moved by it. The axes are unchanged. Points
/// within 5 cm of the sensor are missing returns and left out.
class SensorOriginSource : public DerivedSource {
 public:
  /// @param origins one for each scan
  SensorOriginSource(std::shared_ptr<const ScanSource> whole, std::vector<Eigen::Vector3d> origins);

  /// @throws DataError also if no point is left
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override;
  /// An estimated model is estimated again from the moved points.
  [[nodiscard]] const SensorModel& sensor() const override;

 private:
  std::vector<Eigen::Vector3d> origins_;
  SensorChoice sensor_;
};

}  // namespace raymoval
