// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/finding.h"
#include "datasets/open_sequence.h"

namespace raymoval {

/// Checks the data of `sequence` for common mistakes. It reads about thirty scans, evenly spread,
/// and the poses, sizes and times of all scans. To measure the fit of poses, it reads two scans for
/// each station along the path (see `measure_pose_fit`). The data is not changed.
/// @param threads the largest number of threads; the report does not depend on it
/// @throws DataError if a scan cannot be read; Cancelled
InspectionReport inspect(const Sequence& sequence, int threads = 1,
                         const std::atomic<bool>* cancel = nullptr);

/// The same for a path of `open_sequence`. Some mistakes prevent opening a sequence. If a check
/// exists for the mistake (a pose file with another count, .pcd files without VIEWPOINT), it is a
/// finding. @throws other errors of `open_sequence`
/// @param opened is called with the sequence before its checks; may be null
InspectionReport inspect_path(const std::string& path, const SequenceOptions& options,
                              const OpenContext& context = {},
                              const std::function<void(const Sequence&)>& opened = nullptr);

/// The findings of `inspect_path` that prevent opening the sequence at `path`.
std::vector<Finding> unopenable_findings(const std::string& path, const SequenceOptions& options);

/// All checks of `inspect`, in the order of execution and of the report.
using InspectionCheck = inspection::Check;
const std::vector<InspectionCheck>& inspection_checks();

}  // namespace raymoval
