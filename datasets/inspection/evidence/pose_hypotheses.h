// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// A correction of one kind of wrong poses: the corrected pose of scan `i`.
///
/// It includes a rigid motion that the points lack (points in camera axes, VIEWPOINT applied
/// twice), because only the product of both places the points.
struct PoseHypothesis {
  std::string check;   ///< Check that is reported if the scans agree under it.
  std::string phrase;  ///< "the scans agree ... <phrase>".
  std::function<Pose(std::size_t)> pose;
  std::string remedy = {};  ///< With numbers; empty: the remedy of the check.
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
std::vector<MisreadPoses> misread_poses(Samples& samples);

/// All plausible hypotheses for these poses; refers to `samples.poses()`.
/// @throws DataError as in file_kind.h if the calibration or the poses cannot be read
std::vector<PoseHypothesis> pose_hypotheses(Samples& samples);

}  // namespace raymoval::inspection
