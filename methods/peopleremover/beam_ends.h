// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "methods/peopleremover/direction_index.h"
#include "methods/peopleremover/parameters.h"

namespace raymoval::peopleremover_method {

inline constexpr double kWholeBeam = std::numeric_limits<double>::infinity();

/// Finds how far each beam of a scan may be followed (step 2.3, "point shadows"). Each thread
/// needs one of its own; it keeps its memory from scan to scan.
class BeamEnds {
 public:
  explicit BeamEnds(const Parameters& parameters) : parameters_(parameters) {}

  /// @param points of one scan, sensor frame, metres, none at the origin
  /// @return metres from the sensor along each beam; `kWholeBeam` for the whole of it
  const std::vector<double>& find(const std::vector<Eigen::Vector3d>& points);

 private:
  void sort_by_range();
  void cast_shadow_of(std::size_t owner);
  void find_neighbours(std::size_t owner, double half_sine);
  /// Unit normal of the surface through the neighbours, towards the sensor.
  [[nodiscard]] Eigen::Vector3d normal_at(std::size_t owner) const;

  const Parameters& parameters_;
  DirectionIndex index_;
  std::vector<std::uint32_t> by_range_;  ///< Positions in the index, nearest first.
  std::vector<std::uint32_t> bucket_, start_;
  std::vector<std::uint32_t> neighbours_;  ///< Positions in the index.
  std::vector<double> length_;             ///< Metres, by position in the index.
  std::vector<double> answer_;             ///< Metres, by point.
};

/// The unit eigenvector of the smallest eigenvalue. It is zero if the points of the covariance lie
/// on a line (second eigenvalue below 1e-9 of the largest).
Eigen::Vector3d surface_normal(const Eigen::Matrix3d& covariance);

}  // namespace raymoval::peopleremover_method
