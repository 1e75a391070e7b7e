// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/clean/rows/map_rows.h"

namespace raymoval {

/// `layout` with a float32 field behind it: how sure the method is that a point moves, from 0 to 1.
/// It is called `confidence`, or `raymoval_confidence` if there is a field of that name, which
/// stays as it is.
RecordLayout layout_with_confidence(const RecordLayout& layout);

/// Rows of that layout: `rows`, and the confidence of each.
/// @param steps of each row's point, see `kConfidenceSteps`
ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps);

}  // namespace raymoval
