// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/tables.h"

namespace raymoval {

/// The rows of papers' tables, as columns to set beside a run. They are looked up in the source
/// folder, else where they were installed.
/// @throws DataError if they are in neither place
std::vector<OutsideColumn> published_columns();

}  // namespace raymoval
