// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan_source.h"

namespace raymoval {

/// The scans of another source with their poses in another world frame. Points stay in the sensor
/// frame, so masks by index mean the same in both. Code that uses metres of the world (maps,
/// lattices, single precision) reads scans through this source, so that it loses no digits if the
/// world's origin is far away, as in UTM coordinates.
class LocalFrameSource : public ScanSource {
 public:
  /// @param source must outlive this object
  /// @param T_local_world rigid motion from the world of `source` to the frame wanted
  LocalFrameSource(const ScanSource& source, const Pose& T_local_world)
      : source_(source), T_local_world_(T_local_world) {}

  [[nodiscard]] std::size_t size() const override { return source_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = source_.load(index);
    scan.T_world_sensor = in_local_frame(scan.T_world_sensor);
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    return in_local_frame(source_.pose(index));
  }
  [[nodiscard]] const SensorModel& sensor() const override { return source_.sensor(); }
  [[nodiscard]] const Pose& T_local_world() const { return T_local_world_; }

 private:
  [[nodiscard]] Pose in_local_frame(const Pose& T_world_sensor) const;

  const ScanSource& source_;
  Pose T_local_world_;
};

/// The shortest rotation that maps `up` to +z; multiples of 90 degrees are exact.
/// @param up unit vector
Eigen::Matrix3d turn_to_z(const Eigen::Vector3d& up);

/// The frame that methods run in: its origin is the position of the first scan, exactly, and its z
/// axis points to `up`. If `up` is the world's +z, there is no rotation.
/// @param up unit vector of the world frame of `scans`
/// @return T_local_world; the identity without scans
Pose method_frame(const ScanSource& scans, const Eigen::Vector3d& up);

/// The origin of scores, pictures and pages: the first scan's position rounded to whole
/// kilometres, or the world's origin if the first scan is within `kFarFromOrigin` of it. Voxels
/// whose size divides a kilometre are the same cells from either origin, so counts do not depend
/// on it.
Eigen::Vector3d lattice_origin(const ScanSource& scans);

/// Metres along any axis. Within this distance, single precision resolves a millimetre, and voxel
/// keys (21 bits per axis) cover a scan in voxels down to 0.01 m.
inline constexpr double kFarFromOrigin = 8000.0;

/// The translation that maps `lattice_origin` to zero.
Pose lattice_frame(const ScanSource& scans);

}  // namespace raymoval
