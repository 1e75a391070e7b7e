// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace raymoval {

/// The cluster number of each point. Numbers begin at 0, in the order of the clusters' first
/// points. Two points are joined if their distance is at most gap + growth * (the smaller of their
/// ranges).
/// @param points metres, any frame; @param ranges distance of each point from the sensor, metres
std::vector<int> range_adaptive_clusters(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<double>& ranges, double gap,
                                         double growth);

/// The same in single precision, where points that share a cell of edge gap / sqrt(3) are joined
/// although their distance may round to more than `gap`.
std::vector<int> range_adaptive_clusters(const std::vector<Eigen::Vector3f>& points,
                                         const std::vector<float>& ranges, float gap, float growth);

}  // namespace raymoval
