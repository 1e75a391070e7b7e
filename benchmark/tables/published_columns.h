// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/tables/tables.h"

namespace raymoval {

/// The methods of the paper's Table 2, as columns to set beside a run. The table is looked up in
/// the source folder, else where it was installed.
/// @throws DataError if it is in neither place
std::vector<OutsideColumn> published_columns();

}  // namespace raymoval
