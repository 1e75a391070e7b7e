// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/records/point_records.h"

namespace raymoval {

/// Whether `c` is not printable. A blank is printable.
bool is_unprinted(char c);

/// The rules of a format for field names. Names are always unique and not empty.
struct NameRules {
  bool with_blanks = false;             ///< Whether a name may have blanks and control characters.
  std::size_t most_bytes = 65535;       ///< Of a name, 24 or more.
  std::vector<std::string> taken = {};  ///< Names that mean something else in the format.
};

/// `wanted` with invalid names changed: blanks become '_', long names are truncated, and later
/// duplicates get a number. It takes linear time.
std::vector<std::string> fitting_names(const std::vector<std::string>& wanted,
                                       const NameRules& rules);

/// The names of the single values of a layout's fields: "normal_0", "normal_1" and so on for a
/// field with several values, else the field's name.
std::vector<std::string> value_names(const RecordLayout& layout);

/// The names of the fields.
std::vector<std::string> names_of(const RecordLayout& layout);

/// "The field 'a b' is written as 'a_b'." for each name that changes.
std::vector<std::string> renamed_sentences(const std::vector<std::string>& wanted,
                                           const std::vector<std::string>& names);

/// "The field 'normal' has 3 values, which are written as 'normal_0' to 'normal_2'." for each field
/// with several values.
std::vector<std::string> split_sentences(const RecordLayout& layout);

/// The words of a point layout as fields in their order, including fields "_". Offsets are not set.
/// @throws UsageError naming the word that is wrong, or for a repeated name
std::vector<PointField> point_layout_fields(std::string_view text);

/// The fields of a point from a text of words NAME, NAME:TYPE or NAME:TYPE[COUNT], such as
/// "x y z intensity ring:u2 t:f8". Types are f4 (the default) f8 i1 i2 i4 i8 u1 u2 u4 u8. The name
/// "_" is for padding and may be repeated.
/// @throws UsageError naming the word that is wrong; if x, y or z is missing; for a repeated name
RecordLayout parse_point_layout(std::string_view text);

/// The text that `parse_point_layout` reads as `layout`. Blanks in names become '_'.
std::string point_layout_text(const RecordLayout& layout);

/// The layout of a .bin file: `point_layout`, or x y z intensity as float32.
RecordLayout bin_layout(const std::optional<std::string>& point_layout);

}  // namespace raymoval
