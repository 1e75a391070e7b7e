// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "datasets/inspection/finding.h"
#include "datasets/sequence.h"

namespace raymoval {

/// Looks for the usual mistakes in the data of `sequence`: about thirty scans are read, evenly
/// spread, and the poses, sizes and times of all. Nothing is changed.
/// @throws DataError if a scan cannot be read; Cancelled
InspectionReport inspect(const Sequence& sequence, const std::atomic<bool>* cancel = nullptr);

/// The same for a path as `open_sequence` takes it. Mistakes that keep a sequence from being opened
/// but have a name (a pose file with another count, .pcd files without VIEWPOINT) are findings.
/// @throws what `open_sequence` throws for all others
InspectionReport inspect_path(const std::string& path, const SequenceOptions& options,
                              const OpenContext& context = {});

/// What `inspect` looks for: name, what it finds, remedy, what cleaning does about it.
struct InspectionCheck {
  std::string name, finds, remedy;
  Consequence consequence;
};
std::vector<InspectionCheck> inspection_checks();

}  // namespace raymoval
