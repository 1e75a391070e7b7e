// SPDX-License-Identifier: MIT
#include "datasets/records/point_records.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/error.h"
#include "core/text.h"
#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

template <class Number>
Number number_at(const std::byte* place) {
  Number number;
  std::memcpy(&number, place, sizeof number);
  return number;
}

/// The nearest value of type `Number`; 0 for NaN if `Number` has none.
template <class Number>
Number nearest(double value) {
  if constexpr (std::is_floating_point_v<Number>) {
    return static_cast<Number>(value);
  } else {
    using Limits = std::numeric_limits<Number>;
    if (std::isnan(value)) return 0;
    const double rounded = std::nearbyint(value);
    // 2^63 and 2^64 are doubles and no numbers of their types.
    if (rounded >= static_cast<double>(Limits::max())) return Limits::max();
    if (rounded <= static_cast<double>(Limits::min())) return Limits::min();
    return static_cast<Number>(rounded);
  }
}

bool is_same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

std::size_t offset_of(const PointField& field, int at) {
  return field.offset + static_cast<std::size_t>(field.size) * static_cast<std::size_t>(at);
}

}  // namespace

std::string PointField::text() const {
  const std::string kind = type == 'F' ? "float" : type == 'I' ? "int" : "uint";
  return kind + std::to_string(8 * size) + (count == 1 ? "" : "[" + std::to_string(count) + "]") +
         " " + name;
}

const PointField* RecordLayout::find(const std::vector<std::string_view>& names) const {
  for (const PointField& field : fields) {
    if (std::find(names.begin(), names.end(), field.name) != names.end()) return &field;
  }
  // PDAL and laspy write X Y Z and Intensity.
  for (const PointField& field : fields) {
    const auto same = [&](std::string_view name) { return is_same_word(field.name, name); };
    if (std::any_of(names.begin(), names.end(), same)) return &field;
  }
  return nullptr;
}

void RecordLayout::add(std::string name, char type, int size, int count) {
  fields.push_back({std::move(name), type, size, count, row_bytes});
  row_bytes += fields.back().bytes();
  unnamed = false;
}

double PointRecords::value(std::size_t point, const PointField& field, int at) const {
  const std::byte* place = row(point) + offset_of(field, at);
  return with_number_type(field.type, field.size, [&](auto zero) {
    return static_cast<double>(number_at<decltype(zero)>(place));
  });
}

void PointRecords::set_value(std::size_t point, const PointField& field, double value, int at) {
  std::byte* place = row(point) + offset_of(field, at);
  with_number_type(field.type, field.size, [&](auto zero) {
    const auto number = nearest<decltype(zero)>(value);
    std::memcpy(place, &number, sizeof number);
  });
}

PointRecords PointRecords::chosen(const std::vector<std::uint8_t>& keep) const {
  if (keep.size() != size()) {
    throw InternalError("a choice of " + std::to_string(keep.size()) + " among " +
                        std::to_string(size()) + " records");
  }
  PointRecords result{layout, {}, 0, 1, viewpoint, las};
  result.width = static_cast<std::uint64_t>(
      std::count_if(keep.begin(), keep.end(), [](std::uint8_t kept) { return kept != 0; }));
  result.bytes.resize(result.width * layout.row_bytes);
  std::byte* to = result.bytes.data();
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] == 0) continue;
    std::memcpy(to, row(i), layout.row_bytes);
    to += layout.row_bytes;
  }
  return result;
}

PositionFields position_fields(const RecordLayout& layout, const std::string& where) {
  const auto axis = [&](const char* name) {
    const PointField* field = layout.find({name});
    if (field != nullptr && field->count == 1) return *field;
    std::vector<std::string> names;
    for (const PointField& found : layout.fields) names.push_back(found.name);
    throw DataError(where + ": has no field '" + name + "' with one value a point; found " +
                    (names.empty() ? "no field" : join(names)) + ", expected x y z.");
  };
  return {axis("x"), axis("y"), axis("z")};
}

const std::vector<std::string_view>& intensity_names() {
  static const std::vector<std::string_view> names = {"intensity", "reflectance", "reflectivity"};
  return names;
}

const std::vector<std::string_view>& time_names() {
  static const std::vector<std::string_view> names = {
      "t", "time", "timestamp", "offset_time", "time_offset", "timeOffset", "gps_time"};
  return names;
}

}  // namespace raymoval
