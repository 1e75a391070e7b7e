// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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

}  // namespace raymoval
