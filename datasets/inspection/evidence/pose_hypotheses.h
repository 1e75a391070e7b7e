// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// One way in which poses go wrong, undone: the pose that scan `i` would have.
///
/// A rigid motion that the points themselves are missing (points in camera axes, VIEWPOINT applied
/// twice) is part of it, for only the product of both tells where points come to lie.
struct PoseHypothesis {
  std::string check;   ///< Check that is reported if the scans agree under it.
  std::string phrase;  ///< "the scans agree ... <phrase>".
  std::function<Pose(std::size_t)> pose;
  std::string remedy = {};  ///< With numbers; empty: what the check says in general.
};

/// Poses whose numbers were read in another form than they were written in.
struct MisreadPoses {
  std::string check;
  std::string phrase;
  /// The pose that was meant, from the pose that was read. Both are of the body that has the poses.
  std::function<Pose(const Pose&)> right;
  std::string option;  ///< Reads the form that was meant: "--pose-format inverse".
};

/// Inverse poses, and the other order of quaternions where the pose file has quaternions.
/// @throws DataError if the pose file cannot be read
std::vector<MisreadPoses> misread_poses(const Samples& samples);

/// All that are worth trying for these poses; refers to `samples.poses()`.
/// @throws DataError as file_kind.h says if the calibration or the poses cannot be read
std::vector<PoseHypothesis> pose_hypotheses(const Samples& samples);

}  // namespace raymoval::inspection
