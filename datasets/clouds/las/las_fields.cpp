// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/las_fields.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/field_names.h"

namespace raymoval {
namespace {

/// Builds the record of a format.
class LasRecord {
 public:
  explicit LasRecord(int format) {
    const bool old = format < 6;
    old ? add_old_begin() : add_new_begin();
    if (!old || format == 1 || format >= 3) add("gps_time", 'F', 8);
    const auto has = [&](std::initializer_list<int> formats) {
      return std::find(formats.begin(), formats.end(), format) != formats.end();
    };
    if (has({2, 3, 5, 7, 8, 10})) {
      for (const char* colour : {"red", "green", "blue"}) add(colour, 'U', 2);
    }
    if (has({8, 10})) add("nir", 'U', 2);
    if (has({4, 5, 9, 10})) add_wave_packet();
  }
  std::vector<LasField> fields;
  std::size_t bytes = 12;  ///< X, Y and Z.

 private:
  void add(const char* name, char type, int size) {
    fields.push_back({name, type, size, bytes});
    bytes += static_cast<std::size_t>(size);
  }
  void add_bits(const char* name, int bit, int bits) {
    fields.push_back({name, 'U', 1, bytes, bit, bits});
  }
  void add_old_begin() {
    add("intensity", 'U', 2);
    add_bits("return_number", 0, 3);
    add_bits("number_of_returns", 3, 3);
    add_bits("scan_direction_flag", 6, 1);
    add_bits("edge_of_flight_line", 7, 1);
    ++bytes;
    add_bits("classification", 0, 5);
    add_bits("synthetic", 5, 1);
    add_bits("key_point", 6, 1);
    add_bits("withheld", 7, 1);
    ++bytes;
    add("scan_angle_rank", 'I', 1);
    add("user_data", 'U', 1);
    add("point_source_id", 'U', 2);
  }
  void add_new_begin() {
    add("intensity", 'U', 2);
    add_bits("return_number", 0, 4);
    add_bits("number_of_returns", 4, 4);
    ++bytes;
    add_bits("synthetic", 0, 1);
    add_bits("key_point", 1, 1);
    add_bits("withheld", 2, 1);
    add_bits("overlap", 3, 1);
    add_bits("scanner_channel", 4, 2);
    add_bits("scan_direction_flag", 6, 1);
    add_bits("edge_of_flight_line", 7, 1);
    ++bytes;
    add("classification", 'U', 1);
    add("user_data", 'U', 1);
    add("scan_angle", 'I', 2);
    add("point_source_id", 'U', 2);
  }
  void add_wave_packet() {
    add("wavepacket_index", 'U', 1);
    add("wavepacket_offset", 'U', 8);
    add("wavepacket_size", 'U', 4);
    for (const char* name : {"return_point_wave_location", "x_t", "y_t", "z_t"}) add(name, 'F', 4);
  }
};

const LasRecord& record(int format) {
  static const std::vector<LasRecord> records = [] {
    std::vector<LasRecord> all;
    for (int i = 0; i < kLasFormats; ++i) all.emplace_back(i);
    return all;
  }();
  return records.at(static_cast<std::size_t>(format));
}

}  // namespace

const std::vector<LasField>& las_fields(int format) {
  return record(format).fields;
}

std::size_t las_record_bytes(int format) {
  return record(format).bytes;
}

const std::vector<std::string>& las_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"x", "y", "z", "X", "Y", "Z"};
    for (int format = 0; format < kLasFormats; ++format) {
      for (const LasField& field : las_fields(format)) {
        if (std::find(all.begin(), all.end(), field.name) == all.end())
          all.emplace_back(field.name);
      }
    }
    return all;
  }();
  return names;
}

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

/// Colours in one number, as in PCL.
const PointField* packed_colour(const RecordLayout& layout) {
  const PointField* field = layout.find({"rgb", "rgba"});
  const bool packed =
      field != nullptr && field->count == 1 && field->size == 4 && field->type != 'I';
  return packed ? field : nullptr;
}

/// Adds the values of a field, or its bytes in pieces, as fields of the extra bytes.
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
             // The packed number fills the fields of colours.
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

namespace {

// Places in a description, from the LAS 1.4 specification.
constexpr std::size_t kType = 2, kOptions = 3, kName = 4, kNameBytes = 32, kBounds = 64,
                      kBoundsBytes = 48;
constexpr unsigned kHasMinimum = 2, kHasMaximum = 4;

struct ExtraType {
  char type;
  int size;
};
/// Types 1 to 10. 11 to 20 are the same with two values and 21 to 30 with three; both are
/// deprecated. Type 0 is bytes without a meaning.
constexpr std::array<ExtraType, 10> kExtraTypes = {{{'U', 1},
                                                    {'I', 1},
                                                    {'U', 2},
                                                    {'I', 2},
                                                    {'U', 4},
                                                    {'I', 4},
                                                    {'U', 8},
                                                    {'I', 8},
                                                    {'F', 4},
                                                    {'F', 8}}};

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

PointField described_field(std::string_view description, const std::string& where) {
  const unsigned type = byte_at(description, kType);
  const std::string_view name = description.substr(kName, kNameBytes);
  PointField field;
  field.name = name.substr(0, name.find('\0'));
  if (type > 30) {
    throw DataError(where + ": the extra bytes '" + field.name + "' have the unknown type " +
                    std::to_string(type) + "; expected 0 to 30.");
  }
  if (type == 0) {
    field.type = 'U';
    field.size = 1;
    field.count = static_cast<int>(byte_at(description, kOptions));
  } else {
    field.type = kExtraTypes[(type - 1) % 10].type;
    field.size = kExtraTypes[(type - 1) % 10].size;
    field.count = static_cast<int>(1 + (type - 1) / 10);
  }
  return field;
}

void name_fields(std::vector<ExtraField>& fields) {
  std::vector<std::string> names;
  for (const ExtraField& extra : fields) {
    names.push_back(extra.field.name.empty() ? "extra_bytes" : extra.field.name);
  }
  NameRules rules;
  rules.with_blanks = true;
  rules.taken = las_names();
  names = fitting_names(names, rules);
  for (std::size_t i = 0; i < fields.size(); ++i) fields[i].field.name = names[i];
}

}  // namespace

std::vector<ExtraField> read_extra_fields(std::string_view descriptions, std::size_t bytes,
                                          const std::string& where) {
  std::vector<ExtraField> fields;
  std::size_t at = 0;
  for (; descriptions.size() >= kExtraDescription; descriptions.remove_prefix(kExtraDescription)) {
    const std::string_view description = descriptions.substr(0, kExtraDescription);
    PointField field = described_field(description, where);
    field.offset = at;
    at += field.bytes();
    if (at > bytes) {
      throw DataError(where + ": the description of the extra bytes takes at least " +
                      grouped_text(at) + " bytes a point, but there are " + grouped_text(bytes) +
                      "; the head is damaged.");
    }
    if (field.count > 0) fields.push_back({field, std::string(description)});
  }
  if (at < bytes) {
    ExtraField& rest = fields.emplace_back();
    rest.field = {"undescribed_bytes", 'U', 1, static_cast<int>(bytes - at), at};
  }
  name_fields(fields);
  return fields;
}

std::string extra_description(const PointField& field, const std::string& name,
                              const std::string& known) {
  unsigned type = 0;
  for (std::size_t i = 0; i < kExtraTypes.size() && field.count == 1; ++i) {
    if (kExtraTypes[i].type == field.type && kExtraTypes[i].size == field.size) {
      type = static_cast<unsigned>(i) + 1;
    }
  }
  std::string description(kExtraDescription, '\0');
  if (type != 0 && known.size() == kExtraDescription && byte_at(known, kType) == type) {
    description = known;
    description.replace(kBounds, kBoundsBytes, kBoundsBytes, '\0');
    const unsigned options = byte_at(known, kOptions) & ~(kHasMinimum | kHasMaximum);
    description[kOptions] = static_cast<char>(options);
  } else {
    description[kType] = static_cast<char>(type);
    if (type == 0) description[kOptions] = static_cast<char>(field.count);
  }
  description.replace(kName, kNameBytes, kNameBytes, '\0');
  description.replace(kName, name.size(), name);
  return description;
}

}  // namespace raymoval
