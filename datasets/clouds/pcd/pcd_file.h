// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// PCD 0.7: ascii, binary and binary_compressed are read, binary is written. Padding (fields "_")
/// stands in records as bytes between fields, and such bytes are written as padding.
CloudFormat pcd_format();

}  // namespace raymoval
