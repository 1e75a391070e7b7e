// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// Rows of numbers without a head, little-endian: x y z intensity as float32, or what the reader is
/// told. Rows are written as they are.
CloudFormat bin_format();

/// @param bytes of the file
/// @param layout of a point
/// @throws DataError naming the file and the sizes of a point that would fit
void check_bin_rows(const std::filesystem::path& path, std::uintmax_t bytes,
                    const RecordLayout& layout);

}  // namespace raymoval
