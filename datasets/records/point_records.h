// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// One named value (or `count` of them) of a point record.
struct PointField {
  std::string name;
  char type = 'F';  ///< F real, I signed, U unsigned.
  int size = 4;     ///< Bytes of one value: 1, 2, 4 or 8.
  int count = 1;
  std::size_t offset = 0;  ///< Bytes from the beginning of the record to the first value.

  [[nodiscard]] std::size_t bytes() const {
    return static_cast<std::size_t>(size) * static_cast<std::size_t>(count);
  }
  /// "float32 intensity", for messages.
  [[nodiscard]] std::string text() const;
  bool operator==(const PointField&) const = default;
};

/// The layout of the bytes of a point. Numbers are little-endian. Padding between fields is kept
/// unchanged.
struct RecordLayout {
  std::vector<PointField> fields;
  std::size_t row_bytes = 0;
  /// Whether the file has no field names: columns of an array, numbers of a .bin file.
  bool unnamed = false;

  /// The first field with one of `names`, or null. If no name is equal, case is ignored.
  [[nodiscard]] const PointField* find(const std::vector<std::string_view>& names) const;
  /// Appends a field behind the last byte and sets `unnamed` to false.
  void add(std::string name, char type, int size, int count = 1);
  bool operator==(const RecordLayout&) const = default;
};

struct LasNotes;

/// The points of one scan with all stored fields, bit for bit: N records of `layout.row_bytes`
/// bytes. Points without a return are included; row i is stored point i.
struct PointRecords {
  RecordLayout layout;
  std::vector<std::byte> bytes;  ///< size() * layout.row_bytes.
  /// Rows and columns of an organised cloud (width * height == size()); height 1 if it is not.
  std::uint64_t width = 0, height = 1;
  /// PCD: tx ty tz qw qx qy qz.
  std::optional<Eigen::Matrix<double, 7, 1>> viewpoint = std::nullopt;
  /// LAS: facts of its head, for a LAS file that is written from these points (see las_head.h).
  std::shared_ptr<const LasNotes> las = nullptr;

  [[nodiscard]] std::size_t size() const {
    return layout.row_bytes == 0 ? 0 : bytes.size() / layout.row_bytes;
  }
  [[nodiscard]] const std::byte* row(std::size_t point) const {
    return bytes.data() + point * layout.row_bytes;
  }
  [[nodiscard]] std::byte* row(std::size_t point) {
    return bytes.data() + point * layout.row_bytes;
  }
  /// Value `at` of `field` of a point, as the nearest double.
  [[nodiscard]] double value(std::size_t point, const PointField& field, int at = 0) const;
  /// Writes `value` in the type of `field`; a whole type gets the nearest number.
  void set_value(std::size_t point, const PointField& field, double value, int at = 0);
  /// The rows whose `keep` is not 0, in order, as a cloud that is not organised.
  /// @throws InternalError if there is not one value of `keep` a row
  [[nodiscard]] PointRecords chosen(const std::vector<std::uint8_t>& keep) const;
};

/// The fields x, y and z.
struct PositionFields {
  PointField x, y, z;
};
/// @param where begins the message, such as "scan.pcd"
/// @throws DataError naming the existing fields, if x, y or z is missing or has several values
PositionFields position_fields(const RecordLayout& layout, const std::string& where);

/// Usual names of the intensity of a return, the most common first.
const std::vector<std::string_view>& intensity_names();

/// Usual names of the time of a point (seconds, microseconds, nanoseconds or ticks, from the
/// beginning of its scan or from 1970).
const std::vector<std::string_view>& time_names();

}  // namespace raymoval
