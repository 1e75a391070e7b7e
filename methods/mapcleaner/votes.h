// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/common/thinned_points.h"
#include "methods/mapcleaner/parameters.h"
#include "methods/remover.h"

namespace raymoval::mapcleaner_method {

/// The projection of directions of the sensor frame to an image: rows from below to above, columns
/// counter-clockwise.
struct ImageFrame {
  ImageFrame(const Parameters& parameters, const SensorModel& sensor);

  /// Some points of the sensor frame with their pixels, in arrays that a compiler can vectorise.
  struct Batch {
    static constexpr int kSize = 256;
    std::array<float, kSize> x, y, z;             ///< In: metres.
    std::array<float, kSize> row, column, range;  ///< Out: pixels in fractions, metres.
  };
  /// Fills the rows, columns and ranges of a batch's first points. The error of angles is at most
  /// 1e-6 rad.
  void project(Batch& batch, int count) const;
  /// The pixel of a point of a batch, -1 outside the image or at the sensor.
  [[nodiscard]] int pixel_of(const Batch& batch, int i) const {
    const auto at = static_cast<std::size_t>(i);
    const float row = batch.row[at], column = batch.column[at];
    if (!(row >= 0.0F && row < static_cast<float>(rows)) || !(batch.range[at] > 0.0F)) return -1;
    const int before = static_cast<int>(row) * columns;
    if (column < static_cast<float>(columns)) return before + static_cast<int>(column);
    return is_circle ? before + columns - 1 : -1;  // Rounded beyond the last column.
  }

  int rows = 0, columns = 0;
  bool is_circle = true;                            ///< The last column is beside the first.
  double row_height = 0.0, column_width = 0.0;      ///< Radians.
  double elevation_from = 0.0, azimuth_from = 0.0;  ///< Start of the first row and column, radians.
};

/// The observation of a place by a scan.
enum class Sight : std::int8_t { kNothing, kSeen, kSeenThrough };

/// The range image of a scan, and its observations of places.
class RangeImage {
 public:
  RangeImage(const Parameters& parameters, const SensorModel& sensor);

  [[nodiscard]] const ImageFrame& frame() const { return frame_; }
  /// Replaces the image by the image of a scan.
  void fill(const Scan& scan, int threads);
  /// Range of the image in a pixel, metres; 0 where it is empty.
  [[nodiscard]] float at(int row, int column) const { return ranges_[index(row, column)]; }
  /// Compares a place with the window around its pixel: kSeen if a range is equal within the
  /// tolerance; else kNothing if a range is smaller; else kSeenThrough if a range is larger.
  /// @param range metres from the sensor
  [[nodiscard]] Sight look(int pixel, float range) const;

 private:
  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.columns) +
           static_cast<std::size_t>(column);
  }

  ImageFrame frame_;
  bool keeps_last_;
  int wide_, high_;  ///< Half sizes of the window, pixels.
  float tolerance_;  ///< Metres.
  std::vector<float> ranges_;
  // Of the scan's points.
  std::vector<int> pixels_;
  std::vector<float> point_ranges_;
};

/// The votes of scans on voxels: each scan compares the centroids of voxels around it with its
/// range image, and votes for voxels that it sees and against voxels that it sees through.
class VoxelVotes {
 public:
  /// @param voxels must outlive this object
  VoxelVotes(const Parameters& parameters, const ThinnedPoints& voxels, const SensorModel& sensor);

  /// Adds a scan's votes. Scans must be given in order, because the voxels around a sensor are only
  /// updated now and then. The result does not depend on `context.threads`.
  void add(const Scan& scan, const RunContext& context);
  /// Whether more scans see through a voxel than see it.
  [[nodiscard]] bool is_dynamic(std::size_t voxel) const { return balance_[voxel] > 0; }

 private:
  /// Voxels of an upright square column of the world.
  struct Tile {
    Eigen::Vector3d low, high;       ///< The box around their centroids, metres.
    std::size_t begin = 0, end = 0;  ///< Their indices in `by_tile_`.
  };
  /// The voxels around a place, with their centroids relative to it, metres.
  struct Submap {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    std::vector<std::uint32_t> voxel;
    std::vector<float> x, y, z;
  };

  void sort_into_tiles();
  void choose_submap(const Eigen::Vector3d& place);
  /// Votes on the submap's voxels from `begin` to `end`, at most a batch.
  void vote(const Eigen::Isometry3f& T_sensor_submap, std::size_t begin, std::size_t end);

  double radius_, travel_;
  const ThinnedPoints& voxels_;
  RangeImage image_;
  std::vector<std::uint32_t> by_tile_;  ///< Voxels, tile by tile.
  std::vector<Tile> tiles_;
  bool has_submap_ = false;
  Submap submap_;
  /// Of each voxel: the scans that see through it minus the scans that see it.
  std::vector<std::int32_t> balance_;
};

}  // namespace raymoval::mapcleaner_method
