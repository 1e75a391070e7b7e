// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "datasets/sequence.h"

namespace raymoval {

/// What is done to the poses of a sequence when it is opened.
enum class PoseWork {
  kNone,
  kEstimate,  ///< `--poses estimate`: the scans alone give the poses.
  kRefine,    ///< `--poses refine` or `refine:FILE`: the given poses are improved.
};

/// The work that the user requests with `options.poses`; `options` gets the poses that are read
/// before it.
/// @throws UsageError for options on the poses of a file beside `--poses estimate`
PoseWork take_pose_work(SequenceOptions& options);

/// Estimates or refines the poses of a sequence that was opened without changes to its scans.
/// @throws UsageError for several topics, and for points in the world frame; DataError as
///   `odometry::estimate_poses`; Cancelled
void make_poses(Sequence& sequence, PoseWork work, const OpenContext& context);

/// The poses of the frame of the stored points as a file that `--poses FILE` reads: TUM's format
/// (`t x y z qx qy qz qw`). If the name ends in .kitti or _kitti.txt: KITTI's, 3 x 4 matrices by
/// row.
std::string pose_file_text(const Sequence& sequence, const std::filesystem::path& path);

}  // namespace raymoval
