// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/pose_text.h"

namespace raymoval::pose_formats {

/// How sure the content makes that a text is of a format.
enum class Match {
  kNo,
  kPossible,  ///< It can be read so, but another order of the columns fits as well.
  kYes,
};

/// A form of pose file that is a text.
struct TextFormat {
  PoseFormatName name;
  std::function<Match(const PoseText&)> match;
  std::function<PoseFile(const PoseText&)> read;
};

/// Rows of numbers whose order is fixed: kitti, matrix, tum, euroc, fast-lio, ct-icp, hba.
std::vector<TextFormat> column_formats();
/// Columns with their names above them.
TextFormat named_columns_format();
/// Pose graphs of g2o.
TextFormat g2o_format();

}  // namespace raymoval::pose_formats
