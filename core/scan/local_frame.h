// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

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
  /// @param spin_axis unit vector of the sensor frame of `source`. The sensor frame is turned so
  ///   that this axis becomes z, as methods expect: points and poses change, and no point moves in
  ///   the world. For z, nothing is turned.
  LocalFrameSource(const ScanSource& source, const Pose& T_local_world,
                   const Eigen::Vector3d& spin_axis = Eigen::Vector3d::UnitZ());

  [[nodiscard]] std::size_t size() const override { return source_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override;
  [[nodiscard]] const SensorModel& sensor() const override;
  [[nodiscard]] const Pose& T_local_world() const { return T_local_world_; }

 private:
  const ScanSource& source_;
  Pose T_local_world_;
  Eigen::Matrix3d turn_;
  std::optional<SensorModel> turned_sensor_;  ///< If the sensor frame is turned.
};

/// Turns the points of `scan` and its pose; no point moves in the world.
/// @param turn a rotation of the sensor frame
void turn_sensor_frame(const Eigen::Matrix3d& turn, Scan& scan);

/// The shortest rotation that maps `up` to +z; multiples of 90 degrees are exact.
/// @param up unit vector
Eigen::Matrix3d turn_to_z(const Eigen::Vector3d& up);

/// "-y" for a coordinate axis, else "0.000,0.342,0.940".
std::string axis_text(const Eigen::Vector3d& axis);

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
