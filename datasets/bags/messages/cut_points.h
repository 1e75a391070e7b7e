// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/bags/bag.h"

namespace raymoval {

/// A message with points without those whose `keep` is 0. All else stays bit for bit: the other
/// points, the header, the layout, and what stands behind the points. An organised cloud becomes a
/// row, unless every point stays: then the message stays as it is.
/// @param keep a value for each stored point, in order
/// @param where begins messages: "drive.bag: /points, message 12"
/// @throws DataError as `read_points`; UsageError for a type without points; InternalError if
/// `keep`
///   has not one value a point
std::string without_points(std::string_view message, const std::string& type,
                           MessageEncoding encoding, const std::vector<std::uint8_t>& keep,
                           const std::string& where);

}  // namespace raymoval
