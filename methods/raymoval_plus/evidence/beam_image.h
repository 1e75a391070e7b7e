// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/raymoval_plus/common/parameters.h"

namespace raymoval::raymoval_plus_method {

/// What one scan says of a voxel.
enum class Observation : std::uint8_t { kUnknown, kHit, kPassed, kOpen };

/// The distribution of a voxel's points: their mean is where the voxel is, and this is the inverse
/// of their covariance, 1/m^2, axes of the world.
struct VoxelShape {
  float xx = 0.0F, yy = 0.0F, zz = 0.0F, xy = 0.0F, xz = 0.0F, yz = 0.0F;
  float nearest = 0.0F;  ///< Range from which it was seen at least, metres.
  /// Of a flat voxel: the normal, and how far behind its plane a beam must end to pass, metres; 0
  /// for others.
  float nx = 0.0F, ny = 0.0F, nz = 0.0F, behind = 0.0F;
  float radius = 0.0F;  ///< The largest standard deviation in any direction, metres.
};

/// A voxel that a scan hits or passes through.
struct ObservedVoxel {
  std::uint32_t place;  ///< Its number among those that were asked about.
  Observation observation;
  float range;  ///< Metres from the sensor.
};

/// Step 3: the beams of a scan, sorted by direction, and the test of voxels against those that
/// cross them.
class BeamImage {
 public:
  BeamImage(const SensorModel& sensor, const Parameters& parameters);

  /// Replaces the beams with those of `scan`.
  void fill(const Scan& scan);
  /// Replaces `observed` with the voxels that the scan hits or passes through, in ascending order.
  /// A beam crosses a voxel if it comes within one standard deviation of the voxel's points. It
  /// hits the voxel if it ends there, and passes if it ends well behind. One hit outweighs all
  /// passes.
  /// @param places x y z of the voxels' means from `origin`, axes of the world, metres
  /// @param shapes one for each place
  /// @param origin world frame, metres
  void observe(std::span<const float> places, std::span<const VoxelShape> shapes,
               const Eigen::Vector3d& origin, std::vector<ObservedVoxel>& observed) const;
  /// Where a surface that a point is on goes on: a third of the way to the return of a
  /// neighbouring beam.
  struct Extension {
    std::uint32_t point;
    Eigen::Vector3f offset;  ///< From the point, axes of the world, metres.
  };
  /// Replaces `extensions` with those of all points whose neighbouring beams are far apart and end
  /// at about the same range, in order of points.
  void find_extensions(std::vector<Extension>& extensions) const;
  /// Frees the memory that only `find_extensions` needs.
  void forget_points() { point_of_ = {}; }
  /// The number of bins.
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  }

 private:
  struct Beam {
    float x, y, z;  ///< Direction, axes of the world.
    float range;    ///< Metres.
  };
  [[nodiscard]] int wrapped(int column) const {
    return column < 0 ? column + columns_ : column >= columns_ ? column - columns_ : column;
  }
  [[nodiscard]] float azimuth_bin(const Eigen::Vector3f& p) const;
  [[nodiscard]] float elevation_bin(const Eigen::Vector3f& p, float flat) const;
  [[nodiscard]] std::span<const Beam> beams(int row, int first_column, int last_column) const {
    const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
    const std::uint32_t begin = first_[start + static_cast<std::size_t>(first_column)];
    const std::uint32_t end = first_[start + static_cast<std::size_t>(last_column) + 1];
    return {beams_.data() + begin, end - begin};
  }
  /// The bins whose beams may meet a voxel, and where its mean is among them, in bins. Columns
  /// below 0 and from `columns_` on are those of the other end.
  struct Window {
    float row, column;
    int row0, row1, column0, column1;
  };
  struct Meeting;
  [[nodiscard]] Window window_around(const Eigen::Vector3f& mean, float range, float radius) const;
  /// Whether all beams of a window's blocks end before `range`, metres.
  [[nodiscard]] bool is_hidden(const Window& window, float range) const;
  /// The nearest return of a beam's neighbours, `rows` and `columns` a step, that is most like it.
  [[nodiscard]] const Beam* neighbour(int row, int column, int rows, int columns,
                                      const Beam& of) const;
  /// Tests the beams of a window until one hits.
  void meet(const Window& window, Meeting& meeting) const;
  [[nodiscard]] bool is_open(float row, float column, float range) const;
  void find_farthest();

  int rows_ = 0, columns_ = 0, block_columns_ = 0;
  float azimuth_step_ = 0.0F, elevation_step_ = 0.0F, lowest_ = 0.0F;
  float range_min_, range_max_, hit_, pass_, nearest_;
  Eigen::Matrix3f R_sensor_world_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> first_;  ///< Of each bin in `beams_`, and one more.
  std::vector<Beam> beams_;
  std::vector<std::uint32_t> point_of_;  ///< Of each beam, its number in the scan.
  std::vector<float> farthest_;          ///< Of each block of 8 x 8 bins.
};

}  // namespace raymoval::raymoval_plus_method
