// SPDX-License-Identifier: MIT
#include "datasets/clouds/numpy/npy_array.h"

#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/point_layout.h"
#include "datasets/clouds/numpy/npy_type.h"

namespace raymoval {
namespace {

using Kind = PythonValue::Kind;

/// The text of the head, and what follows it.
std::pair<std::string_view, std::string_view> head_and_body(const CloudBytes& file) {
  const std::string where = file.path.string();
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (!file.text.starts_with(kMagic) || file.text.size() < 12) {
    throw DataError(where + ": is no .npy file: it does not begin with \\x93NUMPY and a head.");
  }
  const int version = static_cast<unsigned char>(file.text[6]);
  if (version < 1 || version > 3) {
    throw DataError(where + ": version " + std::to_string(version) +
                    " of .npy is not known; expected 1, 2 or 3.");
  }
  const std::size_t bytes = version == 1 ? 2 : 4;
  std::uint32_t length = 0;
  std::memcpy(&length, file.text.data() + 8, bytes);
  if (length > file.text.size() - 8 - bytes) {
    throw DataError(where + ": its head has " + grouped_text(length) + " bytes, but only " +
                    grouped_text(file.text.size() - 8 - bytes) +
                    " follow; the file looks truncated. Copy it again.");
  }
  return {file.text.substr(8 + bytes, length), file.text.substr(8 + bytes + length)};
}

}  // namespace

std::string NpyHead::shape_text() const {
  std::vector<std::string> lengths;
  for (const std::uint64_t length : shape) lengths.push_back(grouped_text(length));
  return lengths.empty() ? "a single value" : join(lengths, " x ");
}

NpyHead npy_head(const CloudBytes& file) {
  const std::string where = file.path.string();
  const auto [text, body] = head_and_body(file);
  const PythonValue head = parse_python_value(text, where);
  const PythonValue* descr = head.find("descr");
  const PythonValue* order = head.find("fortran_order");
  const PythonValue* shape = head.find("shape");
  if (descr == nullptr || order == nullptr || shape == nullptr || !shape->is(Kind::kTuple)) {
    throw DataError(where + ": the head of the array lacks 'descr', 'fortran_order' or 'shape'.");
  }
  NpyHead result{npy_type(*descr, where), order->is(Kind::kTrue), {}, body};
  for (const PythonValue& length : shape->items) {
    if (!length.is(Kind::kNumber) || length.number > kMostCloudPoints) {
      throw DataError(where + ": the shape of the array has a length that is no count.");
    }
    result.shape.push_back(length.number);
  }
  return result;
}

namespace {

/// The names and counts of `columns` columns of an array.
std::vector<PointField> column_fields(const CloudBytes& file, std::uint64_t columns) {
  if (file.reading.point_layout) {
    std::vector<PointField> fields = point_layout_fields(*file.reading.point_layout);
    std::uint64_t values = 0;
    for (const PointField& field : fields) values += static_cast<std::uint64_t>(field.count);
    if (values != columns) {
      throw UsageError(file.path.string() + ": the point layout \"" + *file.reading.point_layout +
                       "\" names " + grouped_text(values) + " columns, but the array has " +
                       grouped_text(columns) + ".");
    }
    return fields;
  }
  std::vector<PointField> fields;
  for (std::uint64_t i = 0; i < columns; ++i) {
    static constexpr const char* kNames[] = {"x", "y", "z", "intensity"};
    fields.push_back({i < 4 ? kNames[i] : "field_" + std::to_string(i)});
  }
  return fields;
}

/// Columns of an array of numbers of one type.
void add_number_columns(const CloudBytes& file, const NpyHead& head, std::uint64_t columns,
                        StoredPoints& stored) {
  const NpyField& number = head.type.fields.front();
  const auto size = static_cast<std::size_t>(number.field.size);
  std::size_t at = 0;
  for (const PointField& named : column_fields(file, columns)) {
    PointField field{named.name, number.field.type, number.field.size, named.count, size * at};
    if (head.by_columns && field.count != 1) {
      throw UsageError(file.path.string() +
                       ": the array is stored by columns; name each of them in the point layout.");
    }
    if (field.name == "_") field.name.clear();
    stored.columns.push_back({field, field.offset * (head.by_columns ? stored.points : 1),
                              head.by_columns ? size : stored.row_bytes, number.big_endian});
    at += static_cast<std::size_t>(field.count);
  }
}

void check_plain_shape(const CloudBytes& file, const NpyHead& head) {
  const bool rows = head.shape.size() == 2 || (head.shape.size() == 3 && !head.by_columns);
  const bool one_number = head.type.fields.size() == 1 && head.type.fields[0].field.count == 1;
  if (rows && one_number && head.shape.back() >= 3 && head.shape.back() <= 4096) return;
  throw DataError(file.path.string() + ": the array is " + head.shape_text() +
                  (head.by_columns ? " (by columns)" : "") +
                  "; expected N x 3 numbers or more (x y z intensity), or N items with the fields "
                  "x, y and z. Turn it round, or stack its columns.");
}

/// @throws DataError if the array does not take just the bytes there are
void check_bytes(const CloudBytes& file, const NpyHead& head, std::uint64_t points,
                 std::uint64_t row_bytes) {
  const std::uint64_t bytes = head.body.size();
  if (points <= kMostCloudPoints && points * row_bytes == bytes) return;
  const bool cut = points > bytes / row_bytes;
  throw DataError(file.path.string() + ": the array is " + head.shape_text() + ", " +
                  std::to_string(row_bytes) + " bytes a point, but " + grouped_text(bytes) +
                  " bytes follow its head; the file looks " +
                  (cut ? "truncated. Copy it again." : "like several, and only one is read."));
}

}  // namespace

NpyPoints npy_points(const CloudBytes& file) {
  const NpyHead head = npy_head(file);
  const bool structured = head.type.structured;
  std::vector<std::uint64_t> lengths = head.shape;
  std::uint64_t columns = 1;
  if (!structured) {
    check_plain_shape(file, head);
    columns = lengths.back();
    lengths.pop_back();
  } else if (lengths.empty() || lengths.size() > 2 || (lengths.size() == 2 && head.by_columns)) {
    throw DataError(file.path.string() + ": the array of fields is " + head.shape_text() +
                    (head.by_columns ? " by columns" : "") +
                    "; expected N items, or rows of them.");
  }
  NpyPoints result;
  result.unnamed = !structured;
  result.width = lengths.back();
  result.height = lengths.size() == 2 ? lengths[0] : 1;
  StoredPoints& stored = result.stored;
  stored.bytes = head.body;
  stored.points = result.width * result.height;
  stored.row_bytes = head.type.bytes * columns;
  if (stored.row_bytes == 0) {
    throw DataError(file.path.string() + ": the items of the array have no bytes.");
  }
  check_bytes(file, head, stored.points, stored.row_bytes);
  if (structured) {
    for (const NpyField& field : head.type.fields) {
      stored.columns.push_back(
          {field.field, field.field.offset, stored.row_bytes, field.big_endian});
    }
  } else {
    add_number_columns(file, head, columns, stored);
  }
  return result;
}

}  // namespace raymoval
