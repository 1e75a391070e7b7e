// SPDX-License-Identifier: MIT
#include "benchmark/published_columns.h"

#include "core/error.h"

namespace raymoval {

std::vector<OutsideColumn> published_columns() {
  throw DataError("no published tables are installed.");
}

}  // namespace raymoval
