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

/// The file beside a recording that says which points of which scans move, as DOALS has it
/// ("Dynamic Object Aware LiDAR SLAM based on Automatic Generation of Training Data", 2021): a line
/// for each scan that somebody labelled, with its time in nanoseconds and the numbers of the points
/// that move, in the order of the message, between commas. DOALS labels ten scans of each sequence.
inline constexpr const char* kIndexedLabelsFile = "indices.csv";

/// Labels of the scans of a recording: in a labelled scan 251 of what moves and 9 of the rest, and
/// 0 in all others.
struct IndexedLabels {
  std::shared_ptr<const LabelSource> labels;  ///< Null if no scan is labelled.
  std::string note;                           ///< How many scans are labelled, as a sentence.
};

/// Lines of other scans, such as those that `--frames` leaves out, are counted in the note.
/// @param stamps the time of each scan as its message says it
/// @throws DataError naming the line for what is no number, and for a time that comes twice; while
///   reading labels also for a number that the scan has no point for
IndexedLabels read_indexed_labels(const std::filesystem::path& file,
                                  const std::vector<Nanoseconds>& stamps);

/// What these labels mean: 251 moves, and 0 is ignored.
LabelRule indexed_label_rule();

/// A rule of the user for these labels: 0 is ignored whatever it says, for scans that nobody
/// labelled are not scored. @throws ConfigurationError if 0 moves by it
LabelRule with_unlabelled_ignored(LabelRule rule);

}  // namespace raymoval
