// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/records/point_records.h"

namespace raymoval {

/// The words of a point layout as fields in their order, also those named "_". Offsets are not
/// set. @throws UsageError naming the word that is wrong, or for a name that stands there twice
std::vector<PointField> point_layout_fields(std::string_view text);

/// The fields of a point as a user names them: words NAME, NAME:TYPE or NAME:TYPE[COUNT], such as
/// "x y z intensity ring:u2 t:f8". Types are f4 (where none is given) f8 i1 i2 i4 i8 u1 u2 u4 u8.
/// The name "_" stands for bytes that mean nothing and may stand there several times.
/// @throws UsageError naming the word that is wrong; if x, y or z is missing; for a name that
/// stands
///   there twice
RecordLayout parse_point_layout(std::string_view text);

/// The text that `parse_point_layout` reads as `layout`. Blanks in names become '_'.
std::string point_layout_text(const RecordLayout& layout);

/// The layout of a .bin file: `point_layout`, or x y z intensity as float32.
RecordLayout bin_layout(const std::optional<std::string>& point_layout);

}  // namespace raymoval
