// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/records/point_records.h"

namespace raymoval {

/// Whether `type` is the message that Livox's drivers publish points in.
bool is_livox(const std::string& type);

/// The layout of its points.
RecordLayout livox_layout();

}  // namespace raymoval
