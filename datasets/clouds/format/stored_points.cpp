// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/stored_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

static_assert(std::endian::native == std::endian::little, "point records are little-endian");

/// Whether the values have the same places as in a record, so that whole rows can be copied.
bool is_row_of(const StoredColumn& column, const StoredColumn& first, std::size_t row_bytes) {
  return !column.big_endian && column.step == row_bytes &&
         column.start - column.field.offset == first.start - first.field.offset;
}

void copy_column(const StoredPoints& stored, const StoredColumn& column, PointRecords& records) {
  const PointField& field = column.field;
  const auto size = static_cast<std::size_t>(field.size);
  for (std::size_t i = 0; i < stored.points; ++i) {
    const char* from = stored.bytes.data() + column.start + i * column.step;
    std::byte* to = records.row(i) + field.offset;
    std::memcpy(to, from, field.bytes());
    if (!column.big_endian || size == 1) continue;
    for (std::size_t at = 0; at < field.bytes(); at += size) std::reverse(to + at, to + at + size);
  }
}

template <class Number>
Number number_at(const char* place, bool big_endian) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), place, sizeof(Number));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  Number number;
  std::memcpy(&number, raw.data(), sizeof(Number));
  return number;
}

/// Writes the values of `column` minus `origin` to `to`, `to + to_step` and so on. With an origin
/// of 0, values are rounded once.
void read_column(const StoredPoints& stored, const StoredColumn& column, double origin, float* to,
                 std::size_t to_step) {
  with_number_type(column.field.type, column.field.size, [&](auto zero) {
    const char* from = stored.bytes.data() + column.start;
    for (std::size_t i = 0; i < stored.points; ++i, from += column.step, to += to_step) {
      const auto number = number_at<decltype(zero)>(from, column.big_endian);
      *to = origin == 0.0 ? static_cast<float>(number)
                          : static_cast<float>(static_cast<double>(number) - origin);
    }
  });
}

/// Whether rows are adjacent float32 x y z intensity, as in most files: these take one pass.
bool are_plain_rows(const std::vector<StoredColumn>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const StoredColumn& column = columns[i];
    if (column.big_endian || column.field.type != 'F' || column.field.size != 4) return false;
    if (column.step != columns[0].step || column.start != columns[0].start + 4 * i) return false;
  }
  return columns.size() == 4;
}

void read_plain_rows(const StoredPoints& stored, const StoredColumn& first,
                     const Eigen::Vector3d& origin, Cloud& cloud) {
  const bool far = !origin.isZero(0.0);
  for (std::size_t i = 0; i < stored.points; ++i) {
    std::array<float, 4> row;
    std::memcpy(row.data(), stored.bytes.data() + first.start + i * first.step, sizeof row);
    cloud.points[i] = {row[0], row[1], row[2]};
    if (far) cloud.points[i] = (cloud.points[i].cast<double>() - origin).cast<float>();
    cloud.intensity[i] = row[3];
  }
}

RecordLayout layout_of(const StoredPoints& stored) {
  RecordLayout layout;
  layout.row_bytes = stored.row_bytes;
  for (const StoredColumn& column : stored.columns) {
    if (!column.field.name.empty()) layout.fields.push_back(column.field);
  }
  return layout;
}

}  // namespace

PointRecords records_of(const StoredPoints& stored) {
  PointRecords records;
  records.layout = layout_of(stored);
  records.width = stored.points;
  const auto& columns = stored.columns;
  const bool whole_rows = std::all_of(columns.begin(), columns.end(), [&](const auto& column) {
    return is_row_of(column, columns.front(), stored.row_bytes);
  });
  const std::size_t bytes = stored.points * stored.row_bytes;
  if (whole_rows && bytes > 0 && !columns.empty()) {
    const auto* first = reinterpret_cast<const std::byte*>(stored.bytes.data()) +
                        (columns.front().start - columns.front().field.offset);
    records.bytes.assign(first, first + bytes);
    return records;
  }
  records.bytes.resize(bytes);
  for (const StoredColumn& column : columns) copy_column(stored, column, records);
  return records;
}

std::vector<PointField> cloud_fields(const RecordLayout& layout, const std::string& where) {
  const PositionFields position = position_fields(layout, where);
  std::vector<PointField> fields = {position.x, position.y, position.z};
  const PointField* intensity = layout.find(intensity_names());
  if (intensity != nullptr && intensity->count == 1) fields.push_back(*intensity);
  return fields;
}

Cloud cloud_of(const StoredPoints& stored, const Eigen::Vector3d& origin,
               const std::string& where) {
  std::vector<StoredColumn> wanted;
  for (const PointField& field : cloud_fields(layout_of(stored), where)) {
    wanted.push_back(*std::find_if(stored.columns.begin(), stored.columns.end(),
                                   [&](const auto& column) { return column.field == field; }));
  }
  Cloud cloud;
  cloud.points.resize(stored.points);
  if (wanted.size() > 3) cloud.intensity.resize(stored.points);
  if (stored.points == 0) return cloud;
  if (are_plain_rows(wanted)) {
    read_plain_rows(stored, wanted.front(), origin, cloud);
    return cloud;
  }
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    float* to = c < 3 ? cloud.points.front().data() + c : cloud.intensity.data();
    read_column(stored, wanted[c], origin_of(c, origin), to, c < 3 ? 3 : 1);
  }
  return cloud;
}

}  // namespace raymoval
