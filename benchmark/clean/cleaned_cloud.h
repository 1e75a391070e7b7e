// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "datasets/sequence.h"

namespace raymoval {

/// A map that a program has cleaned. The points are finite and in the world frame, relative to the
/// origin of scores (see `lattice_origin`). They are sorted, so that their order in the file has no
/// effect.
struct CleanedCloud {
  std::vector<Eigen::Vector3f> points;
  std::size_t stored = 0;      ///< Points in the file.
  std::size_t non_finite = 0;  ///< Points with a coordinate that is not finite; left out.

  /// Warnings, in sentences, for a reader of the scores.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

CleanedCloud cleaned_cloud(std::vector<Eigen::Vector3f> points);

/// @param origin of the points in memory, in the world frame of the file
/// @throws DataError, UsageError as `read_cloud`
CleanedCloud read_cleaned_cloud(const std::filesystem::path& path,
                                const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

/// The cloud of all points that do not move according to the labels of the sequence. It is the
/// result of a perfect method.
/// @param voxel_size in metres; 0 keeps every point
CleanedCloud oracle_cloud(const Sequence& sequence, double voxel_size, Progress* progress);
/// The same with all points: the result of a method that removes nothing.
CleanedCloud whole_cloud(const Sequence& sequence, double voxel_size, Progress* progress);

}  // namespace raymoval
