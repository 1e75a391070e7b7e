// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval {

/// The side file of a simulated scene that says who moves when.
inline constexpr const char* kMoversFile = "movers.json";

/// `labels` in which only what moves at the time of the scan has a moving label. What stands then,
/// though it moves at another time, has the static label of its kind ("car" for "moving-car") and
/// keeps its instance. Words whose instance is not in `file` stay as they are.
/// @param file `kMoversFile` of the sequence
/// @param frames number of the frame of each scan
/// @throws DataError if `file` is absent or cannot be read; ConfigurationError for a damaged one
std::shared_ptr<const LabelSource> moving_now_labels(std::shared_ptr<const LabelSource> labels,
                                                     const std::filesystem::path& file,
                                                     std::vector<long> frames);

}  // namespace raymoval
