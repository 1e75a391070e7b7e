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

/// A map that some program says is static: finite points in the world frame, from the origin that
/// scores have (see `lattice_origin`), sorted, so that their order in the file cannot matter.
struct CleanedCloud {
  std::vector<Eigen::Vector3f> points;
  std::size_t stored = 0;      ///< Points in the file.
  std::size_t non_finite = 0;  ///< Of these, with a coordinate that is no number; left out.

  /// What a reader of its scores has to know; empty if all is well.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

CleanedCloud cleaned_cloud(std::vector<Eigen::Vector3f> points);

/// @param origin of the points in memory, in the world of the file
/// @throws DataError, UsageError as `read_cloud`
CleanedCloud read_cleaned_cloud(const std::filesystem::path& path,
                                const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

/// The cloud of all points that do not move by the sequence's labels: the best that a method can
/// hand in.
/// @param voxel_size metres; 0 keeps every point
CleanedCloud oracle_cloud(const Sequence& sequence, double voxel_size, Progress* progress);

}  // namespace raymoval
