// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/finding.h"
#include "datasets/open_sequence.h"

namespace raymoval {

/// Looks for the usual mistakes in the data of `sequence`: about thirty scans are read, evenly
/// spread, and the poses, sizes and times of all; to measure how well poses fit, two scans for each
/// station along the path (see `measure_pose_fit`). Nothing is changed.
/// @param threads the largest number of threads; the report does not depend on it
/// @throws DataError if a scan cannot be read; Cancelled
InspectionReport inspect(const Sequence& sequence, int threads = 1,
                         const std::atomic<bool>* cancel = nullptr);

/// The same for a path as `open_sequence` takes it. Some mistakes keep a sequence from being
/// opened: those that have a name (a pose file with another count, .pcd files without VIEWPOINT)
/// are findings. @throws for all others what `open_sequence` throws
InspectionReport inspect_path(const std::string& path, const SequenceOptions& options,
                              const OpenContext& context = {});

/// Those findings of `inspect_path` that keep the sequence at `path` from being opened.
std::vector<Finding> unopenable_findings(const std::string& path, const SequenceOptions& options);

/// All that `inspect` looks for, in the order in which it is looked for and reported.
using InspectionCheck = inspection::Check;
const std::vector<InspectionCheck>& inspection_checks();

}  // namespace raymoval
