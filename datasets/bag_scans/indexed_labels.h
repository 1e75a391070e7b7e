// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/scan/label_rule.h"
#include "core/scan/scan_source.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// The label file of DOALS beside a recording ("Dynamic Object Aware LiDAR SLAM based on Automatic
/// Generation of Training Data", 2021). Each line is a labelled scan: its time in nanoseconds and
/// the indices of its moving points in the message, separated by commas. DOALS labels ten scans of
/// each sequence.
inline constexpr const char* kIndexedLabelsFile = "indices.csv";

/// Labels of the scans of a recording. In a labelled scan, moving points have 251 and others 9. In
/// other scans, all points have 0.
struct IndexedLabels {
  std::shared_ptr<const LabelSource> labels;  ///< Null if no scan is labelled.
  std::string note;                           ///< How many scans are labelled, as a sentence.
};

/// Lines of other scans, such as scans that `--frames` leaves out, are counted in the note.
/// @param stamps the stamp in the message of each scan
/// @throws DataError naming the line, for a word that is no number or a repeated time; while
///   reading labels also for an index beyond the points of the scan
IndexedLabels read_indexed_labels(const std::filesystem::path& file,
                                  const std::vector<Nanoseconds>& stamps);

/// What these labels mean: 251 moves, and 0 is ignored.
LabelRule indexed_label_rule();

/// The user's `rule` with 0 ignored, so that unlabelled scans are not scored.
/// @throws ConfigurationError if 0 moves in `rule`
LabelRule with_unlabelled_ignored(LabelRule rule);

}  // namespace raymoval
