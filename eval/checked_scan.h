// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scan/mask_store.h"
#include "eval/protocol.h"

namespace raymoval {

/// A scan with its label words and, if masks are scored, its mask. All have the same length.
struct CheckedScan {
  Scan scan;                          ///< Points and pose.
  std::vector<std::uint32_t> labels;  ///< One word for each point.
  Mask mask;                          ///< Empty without masks.

  [[nodiscard]] bool removed(std::size_t point) const { return !mask.empty() && mask[point] != 0; }
};

/// Loads scan `index` with its labels and its mask.
/// @param masks null: the scan gets no mask
/// @throws MethodError if the mask is missing or has the wrong length
/// @throws DataError if the labels do not fit the scan
CheckedScan load_checked(const EvaluationInput& input, const MaskStore* masks, std::size_t index);

/// Throws DataError: a scan has a point where there was none when the protocol was opened.
[[noreturn]] void throw_changed(const EvaluationInput& input, std::size_t index);

/// @throws MethodError unless there is a mask for each scan
void check_mask_count(const EvaluationInput& input, const MaskStore& masks);

}  // namespace raymoval
