// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// LAS 1.0 to 1.4 with the point formats 0 to 10; LAS 1.4 with the formats 6 to 8 is written (see
/// las_encoder.h). Coordinates are float64 fields x, y and z in metres, values of a few bits are
/// uint8 fields, and extra bytes are fields as they are described; their scales are not applied.
CloudFormat las_format();

}  // namespace raymoval
