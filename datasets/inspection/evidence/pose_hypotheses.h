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

/// All that are worth trying for these poses; refers to `samples.poses()`.
/// @throws DataError as file_kind.h says if the calibration or the poses cannot be read
std::vector<PoseHypothesis> pose_hypotheses(const Samples& samples);

}  // namespace raymoval::inspection
