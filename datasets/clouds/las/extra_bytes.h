// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/records/point_records.h"

namespace raymoval {

/// Bytes of the description of a field in the extra bytes, and how many descriptions a record of
/// variable length can have.
inline constexpr std::size_t kExtraDescription = 192;
inline constexpr std::size_t kMostExtraFields = 341;

/// A field behind the standard ones of a LAS point.
struct ExtraField {
  PointField field;         ///< Its offset is from the first extra byte.
  std::string description;  ///< As in the file.
};

/// The fields that the record "extra bytes" describes. Bytes that it does not describe are a field
/// of uint8 values behind the others; a field of no bytes is left out.
/// @param descriptions the record
/// @param bytes how many extra bytes a point has
/// @throws DataError naming `where` if they do not fit, or for an unknown type
std::vector<ExtraField> read_extra_fields(std::string_view descriptions, std::size_t bytes,
                                          const std::string& where);

/// The description of a field of one value, or of bytes (uint8, up to 255 values).
/// @param name of up to 32 bytes
/// @param known the description that the field had in the file that it comes from, or empty: scale,
///   offset, text and so on are taken over if the type is the same; the bounds are not
std::string extra_description(const PointField& field, const std::string& name,
                              const std::string& known);

}  // namespace raymoval
