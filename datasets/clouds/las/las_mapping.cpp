// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/las_mapping.h"

#include <algorithm>
#include <string_view>

#include "datasets/clouds/format/field_names.h"

namespace raymoval {
namespace {

const PointField* find_fitting(const RecordLayout& layout, const LasField& to) {
  const PointField* field = layout.find({to.name});
  return field != nullptr && fits(*field, to) ? field : nullptr;
}

/// Whether points have all colours of `format`.
bool has_colours(const RecordLayout& layout, int format) {
  constexpr std::string_view kColours[] = {"red", "green", "blue", "nir"};
  for (const LasField& to : las_fields(format)) {
    const bool colour =
        std::find(std::begin(kColours), std::end(kColours), to.name) != std::end(kColours);
    if (colour && find_fitting(layout, to) == nullptr) return false;
  }
  return true;
}

/// Colours in one number, as PCL has them.
const PointField* packed_colour(const RecordLayout& layout) {
  const PointField* field = layout.find({"rgb", "rgba"});
  const bool packed =
      field != nullptr && field->count == 1 && field->size == 4 && field->type != 'I';
  return packed ? field : nullptr;
}

/// The values of a field, or its bytes in pieces, as fields of the extra bytes.
void add_extra(const PointField& field, LasMapping& mapping) {
  const bool bytes = field.type == 'U' && field.size == 1 && field.count > 1;
  const int piece = bytes ? std::min(field.count, 255) : 1;
  for (int at = 0; at < field.count; at += piece) {
    PointField part = field;
    part.count = std::min(piece, field.count - at);
    part.offset += static_cast<std::size_t>(at) * static_cast<std::size_t>(field.size);
    const bool whole = part.count == field.count;
    mapping.extra.push_back(
        {part, whole ? field.name : field.name + "_" + std::to_string(at / piece), field.name});
    mapping.record_bytes += part.bytes();
  }
}

void name_extra(LasMapping& mapping) {
  std::vector<std::string> names;
  for (const LasMapping::Extra& extra : mapping.extra) names.push_back(extra.name);
  NameRules rules;
  rules.with_blanks = true;
  rules.most_bytes = 32;
  rules.taken = las_names();
  names = fitting_names(names, rules);
  for (std::size_t i = 0; i < names.size(); ++i) mapping.extra[i].name = names[i];
}

}  // namespace

bool fits(const PointField& field, const LasField& to) {
  if (field.count != 1 || field.type != to.type) return false;
  if (to.bits != 0 || to.type == 'F') return field.size == to.size;
  return field.size <= to.size;
}

LasMapping map_to_las(const RecordLayout& layout) {
  LasMapping mapping;
  const bool coloured = has_colours(layout, 7);
  const PointField* packed = coloured ? nullptr : packed_colour(layout);
  mapping.format = has_colours(layout, 8) ? 8 : coloured || packed != nullptr ? 7 : 6;
  mapping.record_bytes = las_record_bytes(mapping.format);
  mapping.shown_colour = packed;
  const PositionFields position = position_fields(layout, "points");
  for (const PointField& field : layout.fields) {
    if (field == position.x || field == position.y || field == position.z) continue;
    const auto& all = las_fields(mapping.format);
    const auto to = std::find_if(all.begin(), all.end(), [&](const LasField& known) {
      return known.name == field.name && find_fitting(layout, known) == &field &&
             // The places of colours are taken by those of the packed number.
             (packed == nullptr || known.at < las_record_bytes(6));
    });
    if (to != all.end()) {
      mapping.standard.push_back({field, *to});
      if (field.name == "return_number") mapping.assumed_returns &= 0xF0U;
      if (field.name == "number_of_returns") mapping.assumed_returns &= 0x0FU;
      continue;
    }
    if (field.name == "scan_angle_rank" && field.type == 'I' && field.bytes() == 1) {
      mapping.shown_angle = &field;
    }
    add_extra(field, mapping);
  }
  const PointField* intensity = layout.find(intensity_names());
  if (intensity != nullptr && intensity->count == 1 &&
      std::none_of(mapping.standard.begin(), mapping.standard.end(),
                   [](const auto& one) { return std::string_view(one.to.name) == "intensity"; })) {
    mapping.shown_intensity = intensity;
  }
  name_extra(mapping);
  return mapping;
}

}  // namespace raymoval
