// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/extra_bytes.h"

#include <array>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/las/las_layout.h"

namespace raymoval {
namespace {

// Places in a description, as the LAS 1.4 specification has them.
constexpr std::size_t kType = 2, kOptions = 3, kName = 4, kNameBytes = 32, kBounds = 64,
                      kBoundsBytes = 48;
constexpr unsigned kHasMinimum = 2, kHasMaximum = 4;

struct ExtraType {
  char type;
  int size;
};
/// Types 1 to 10. 11 to 20 are the same with two values and 21 to 30 with three; both are
/// deprecated. Type 0 is bytes without a meaning.
constexpr std::array<ExtraType, 10> kTypes = {{{'U', 1},
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
    field.type = kTypes[(type - 1) % 10].type;
    field.size = kTypes[(type - 1) % 10].size;
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
  for (std::size_t i = 0; i < kTypes.size() && field.count == 1; ++i) {
    if (kTypes[i].type == field.type && kTypes[i].size == field.size) {
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
