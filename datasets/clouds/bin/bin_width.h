// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/clouds/format/cloud_bytes.h"

namespace raymoval {

/// Refuses .bin scans whose points are of 3, 5, 6 or 7 float32 and would be read as points of 4.
///
/// The right width tells its columns apart: x, z and a ring are spread differently. Under a wrong
/// width each column has a little of all. So scans are refused only if their columns differ under
/// the other width and are alike under 4, in each of up to five scans, and if the size of every
/// scan fits the other width. Columns are compared by the distance of Kolmogorov and Smirnov, which
/// does not depend on the order of points, on units, or on what a column means.
/// @param scans files of any format; those in other ones than .bin are not looked at, nor those
/// with fewer than 2,520 numbers
/// @throws DataError naming a scan and the width that fits, unless `reading` names the point layout
/// @note Points of 8 float32 look like points of 4, and are not found.
void check_bin_width(const std::vector<std::filesystem::path>& scans, const RecordReading& reading);

}  // namespace raymoval
