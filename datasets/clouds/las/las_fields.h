// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// A value of a LAS point record beside X, Y and Z.
struct LasField {
  const char* name;
  char type;           ///< As in `PointField`.
  int size;            ///< Bytes.
  std::size_t at = 0;  ///< Place of its first byte in the record.
  int bit = 0;         ///< Of a value of a few bits: the lowest of them.
  int bits = 0;        ///< 0: whole bytes.
};

/// The point formats that there are: 0 to 10.
inline constexpr int kLasFormats = 11;

/// The fields of a point format in the order of the record, as the LAS 1.4 specification has them.
const std::vector<LasField>& las_fields(int format);

/// Bytes of a record of a point format, without extra bytes.
std::size_t las_record_bytes(int format);

/// The names of all fields of all formats, and those of the coordinates.
const std::vector<std::string>& las_names();

/// Where the fields of points go in the records of a LAS file.
struct LasMapping {
  /// A field that LAS has.
  struct Standard {
    PointField from;
    LasField to;
  };
  /// Bytes of a field that LAS does not have: a value, or up to 255 bytes that belong together.
  struct Extra {
    PointField from;   ///< Its offset is that of the bytes in the records.
    std::string name;  ///< At most 32 bytes.
    std::string of;    ///< The field's own name.
  };
  int format = 6;
  std::size_t record_bytes = 0;
  std::vector<Standard> standard;
  std::vector<Extra> extra;
  /// Fields that the extra bytes have, and that are also written where viewers look for them.
  const PointField *shown_intensity = nullptr, *shown_colour = nullptr, *shown_angle = nullptr;
  /// The bits of the return number and the number of returns, of which points without them have 1.
  unsigned assumed_returns = 0x11;
};

/// @param layout outlives the result
LasMapping map_to_las(const RecordLayout& layout);

/// Whether `field` can go where LAS has `to`, each value as it is.
bool fits(const PointField& field, const LasField& to);

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

/// Writes LAS 1.4: point format 6, with colours 7, with near infrared 8.
///
/// A field whose name and type LAS has goes where LAS has it (a smaller whole type also); every
/// other one becomes a field of the extra bytes. Besides, real intensities are written rounded (see
/// `RecordWriting::intensity_scale`) where viewers look, and colours that are packed in one number
/// likewise. Coordinates are whole multiples of a scale from an offset: those of the LAS file that
/// the first points come from, else 0.001 m and a place near the first points. A reference
/// system that that file says as WKT is said again.
std::unique_ptr<RecordEncoder> las_encoder(const std::filesystem::path& path,
                                           const RecordWriting& writing);

/// As `shown_intensity`.
std::optional<ShownIntensity> shown_in_las(const RecordLayout& layout);

/// As `what_is_lost`.
std::vector<std::string> lost_in_las(const RecordLayout& layout);

}  // namespace raymoval
