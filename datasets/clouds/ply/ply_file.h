// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// PLY 1.0: ascii and binary of either endianness are read, binary little-endian is written. Other
/// elements, before and after the vertices, are skipped.
CloudFormat ply_format();

}  // namespace raymoval
