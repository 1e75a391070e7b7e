// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/row_layout.h"

#include <algorithm>
#include <string_view>

#include "core/text.h"

namespace raymoval {
namespace {

bool is_position(const PointField& field) {
  constexpr std::string_view kAxes = "xyzXYZ";
  return field.count == 1 && field.name.size() == 1 &&
         kAxes.find(field.name) != std::string_view::npos;
}

/// The bytes of x, y or z in a map whose points are not the stored ones.
int coordinate_size(const PointField& stored, Coordinates coordinates) {
  if (coordinates == Coordinates::kDouble) return 8;
  return stored.type == 'F' ? stored.size : 4;
}

const PointField* named(const RecordLayout& layout, const std::string& name) {
  return layout.find({name});
}

bool same_kind(const PointField& a, const PointField& b) {
  return a.type == b.type && a.size == b.size && a.count == b.count;
}

bool is_real(const PointField* field, int count) {
  return field != nullptr && field->type == 'F' && field->count == count;
}

}  // namespace

RecordLayout map_layout(const RecordLayout& stored, PointFrame frame, Coordinates coordinates,
                        const std::string& where) {
  position_fields(stored, where);
  if (frame == PointFrame::kWorld) return stored;
  const bool fits = std::all_of(stored.fields.begin(), stored.fields.end(), [&](const auto& field) {
    return !is_position(field) ||
           (field.type == 'F' && field.size == coordinate_size(field, coordinates));
  });
  if (fits) return stored;
  RecordLayout layout;
  for (const PointField& field : stored.fields) {
    if (is_position(field)) {
      layout.add(field.name, 'F', coordinate_size(field, coordinates));
    } else {
      layout.add(field.name, field.type, field.size, field.count);
    }
  }
  return layout;
}

RecordLayout plain_layout(Coordinates coordinates) {
  RecordLayout layout;
  for (const char* axis : {"x", "y", "z"}) {
    layout.add(axis, 'F', coordinates == Coordinates::kDouble ? 8 : 4);
  }
  layout.add("intensity", 'F', 4);
  return layout;
}

std::string field_difference(const RecordLayout& layout, const RecordLayout& expected) {
  for (const PointField& field : expected.fields) {
    const PointField* found = named(layout, field.name);
    if (found == nullptr) return "has no field '" + field.name + "'";
    if (!same_kind(*found, field)) return "has " + found->text() + " in place of " + field.text();
  }
  for (const PointField& field : layout.fields) {
    if (named(expected, field.name) == nullptr) return "has a field '" + field.name + "' as well";
  }
  return "";
}

std::vector<NormalFields> normal_fields(const RecordLayout& layout) {
  std::vector<NormalFields> normals;
  for (const auto& names :
       {std::array{"normal_x", "normal_y", "normal_z"}, std::array{"nx", "ny", "nz"}}) {
    const PointField *x = layout.find({names[0]}), *y = layout.find({names[1]}),
                     *z = layout.find({names[2]});
    if (is_real(x, 1) && is_real(y, 1) && is_real(z, 1)) normals.push_back({*x, *y, *z});
  }
  const PointField* whole = layout.find({"normal"});
  if (!is_real(whole, 3)) return normals;
  NormalFields parts{*whole, *whole, *whole};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].count = 1;
    parts[i].offset += i * static_cast<std::size_t>(whole->size);
  }
  normals.push_back(parts);
  return normals;
}

const PointField* intensity_field(const RecordLayout& layout) {
  for (const std::string_view name : intensity_names()) {
    const PointField* field = layout.find({name});
    if (field != nullptr && field->count == 1) return field;
  }
  return nullptr;
}

RowCopy::RowCopy(const RecordLayout& from, const RecordLayout& to) {
  if (from == to) {
    is_whole_ = true;
    pieces_ = {{0, 0, from.row_bytes}};
    return;
  }
  for (const PointField& field : to.fields) {
    const PointField* source = named(from, field.name);
    if (source == nullptr || !same_kind(*source, field)) continue;
    const Piece piece{source->offset, field.offset, field.bytes()};
    const bool goes_on = !pieces_.empty() &&
                         pieces_.back().from + pieces_.back().bytes == piece.from &&
                         pieces_.back().to + pieces_.back().bytes == piece.to;
    if (goes_on) {
      pieces_.back().bytes += piece.bytes;
    } else {
      pieces_.push_back(piece);
    }
  }
}

}  // namespace raymoval
