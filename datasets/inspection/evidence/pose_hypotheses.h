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

/// All plausible hypotheses for these poses; refers to `samples.poses()`.
/// @throws DataError as in file_kind.h if the calibration or the poses cannot be read
std::vector<PoseHypothesis> pose_hypotheses(const Samples& samples);

}  // namespace raymoval::inspection
