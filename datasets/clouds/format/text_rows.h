// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/records/point_records.h"

namespace raymoval {

/// Points as lines of text: the values of `fields` between blanks, each by the shortest text that
/// reads back as the same number (nan for what is none).
std::string text_rows(const PointRecords& records, const std::vector<PointField>& fields);

}  // namespace raymoval
