// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/layout.h"

namespace raymoval {

/// A part of a SemanticKITTI sequence that papers use for comparisons.
struct PaperSegment {
  std::string name;      ///< "kitti-05".
  std::string sequence;  ///< "05".
  FrameRange frames;
};

/// The five segments of the ERASOR protocol, with the strides of its published data.
const std::vector<PaperSegment>& paper_segments();

/// Sequences of SemanticKITTI: folders with `velodyne/NNNNNN.bin`, `poses.txt` with one row for
/// each frame number from 0, `calib.txt` with the row `Tr:` (T_world_sensor = Tr^-1 P Tr), and
/// perhaps `labels/NNNNNN.label`, `times.txt` and `sequence.json`.
///
/// Without calib.txt, sequence.json must have `"poses_are_lidar": true`: the poses are those of the
/// LiDAR. Frames may be absent from the disk (a partial copy), but each frame number on the disk
/// must have a row in the pose file. Labels: 252-259 move, none is ignored.
Layout semantickitti_layout();

/// `ROOT:05` or `ROOT:kitti-05`: a sequence of a root folder, or a segment of papers.
Layout semantickitti_root_layout();

/// Defaults of a sequence, used if neither an option nor its sequence.json has a value.
struct SemanticKittiDefaults {
  std::string name;   ///< Replaces the name of sequence.json; empty: name of the folder.
  FrameRange frames;  ///< Used unless an option gives frames.
  LabelRule label_rule;
};

/// Opens a sequence folder of `semantickitti_layout`.
/// @throws DataError, UsageError or ConfigurationError naming what was found and what was expected
Sequence open_semantickitti(const std::filesystem::path& folder, const SequenceOptions& options,
                            const OpenContext& context = {},
                            const SemanticKittiDefaults& defaults = {});

}  // namespace raymoval
