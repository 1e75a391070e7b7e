// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "datasets/clouds/las/las_notes.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// Coordinates of a LAS file that is written: whole numbers of 32 bits times a scale from an
/// offset.
class LasGrid {
 public:
  /// @param where the file, for messages
  /// @param first the points that the file begins with
  /// @param notes the scale and offset to use if `first` lies within them, or null
  LasGrid(std::string where, const PointRecords& first, const LasNotes* notes);

  /// Writes the three numbers of a place to `to`.
  /// @param point number in the file, for messages
  /// @throws DataError if the place is not finite or beyond what the numbers reach
  void encode(const Eigen::Vector3d& place, std::uint64_t point, char* to);

  /// Writes scale, offset and the bounds of what was encoded into the head of a LAS file.
  void put_into(std::string& head) const;

 private:
  std::string where_;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Constant(0.001);
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  Eigen::Array3d least_, most_;  ///< Of the numbers; least > most if there are none.
};

}  // namespace raymoval
