// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// A value of a LAS point record other than X, Y and Z.
struct LasField {
  const char* name;
  char type;           ///< As in `PointField`.
  int size;            ///< Bytes.
  std::size_t at = 0;  ///< Place of its first byte in the record.
  int bit = 0;         ///< Lowest bit, for a value of a few bits.
  int bits = 0;        ///< 0: whole bytes.
};

/// Number of point formats: 0 to 10.
inline constexpr int kLasFormats = 11;

/// The fields of a point format in the order of the record (LAS 1.4 specification).
const std::vector<LasField>& las_fields(int format);

/// Bytes of a record of a point format, without extra bytes.
std::size_t las_record_bytes(int format);

/// The names of all fields of all formats, and those of the coordinates.
const std::vector<std::string>& las_names();

/// The place of each field of points in the records of a LAS file.
struct LasMapping {
  /// A standard field of LAS.
  struct Standard {
    PointField from;
    LasField to;
  };
  /// Extra bytes of another field: a value, or up to 255 bytes that belong together.
  struct Extra {
    PointField from;   ///< Its offset is that of the bytes in the records.
    std::string name;  ///< At most 32 bytes.
    std::string of;    ///< The field's own name.
  };
  int format = 6;
  std::size_t record_bytes = 0;
  std::vector<Standard> standard;
  std::vector<Extra> extra;
  /// Fields of the extra bytes that are also written to standard fields, for viewers.
  const PointField *shown_intensity = nullptr, *shown_colour = nullptr, *shown_angle = nullptr;
  /// The bits of the return number and the number of returns; both are 1 for points without them.
  unsigned assumed_returns = 0x11;
};

/// @param layout outlives the result
LasMapping map_to_las(const RecordLayout& layout);

/// Whether the LAS field `to` can store each value of `field` unchanged.
bool fits(const PointField& field, const LasField& to);

/// Bytes of the description of a field in the extra bytes, and the largest number of descriptions
/// in a record of variable length.
inline constexpr std::size_t kExtraDescription = 192;
inline constexpr std::size_t kMostExtraFields = 341;

/// A field behind the standard fields of a LAS point.
struct ExtraField {
  PointField field;         ///< Its offset is from the first extra byte.
  std::string description;  ///< As in the file.
};

/// The fields that the record "extra bytes" describes. Bytes without a description become a field
/// of uint8 values behind the others; a field of no bytes is left out.
/// @param descriptions the record
/// @param bytes number of extra bytes of a point
/// @throws DataError naming `where` if they do not fit, or for an unknown type
std::vector<ExtraField> read_extra_fields(std::string_view descriptions, std::size_t bytes,
                                          const std::string& where);

/// The description of a field of one value, or of bytes (uint8, up to 255 values).
/// @param name of up to 32 bytes
/// @param known the description of the field in its original file, or empty: scale, offset, text
///   and so on are copied if the type is the same; the bounds are not
std::string extra_description(const PointField& field, const std::string& name,
                              const std::string& known);

/// Writes LAS 1.4: point format 6, with colours 7, with near infrared 8.
///
/// A field with the name and type of a standard LAS field (or a smaller whole type) becomes that
/// field; every other field becomes extra bytes. Real intensities (rounded)
/// and colours in one number are also written to the standard fields for viewers. Coordinates are
/// whole multiples of a scale from an offset. Scale, offset and a WKT reference system are copied
/// from the LAS file of the first points; for other points, the scale is 0.001 m and the offset is
/// near the first points.
std::unique_ptr<RecordEncoder> las_encoder(const std::filesystem::path& path);

/// As `format_losses`.
std::vector<std::string> lost_in_las(const RecordLayout& layout);

}  // namespace raymoval
