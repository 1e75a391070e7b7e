// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/point_layout.h"

#include <algorithm>
#include <unordered_set>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/field_names.h"

namespace raymoval {
namespace {

constexpr const char* kForm =
    "expected the fields of a point in their order, as NAME or NAME:TYPE with the types f4 f8 i1 "
    "i2 i4 i8 u1 u2 u4 u8 (f4 where none is given), such as \"x y z intensity ring:u2 t:f8\".";

[[noreturn]] void fail(std::string_view text, std::string_view word, const std::string& what) {
  throw UsageError("point layout \"" + std::string(text.substr(0, 200)) + "\": '" +
                   std::string(word.substr(0, 60)) + "' " + what + "; " + kForm);
}

/// "f8" or "f4[3]" as a field without a name.
std::optional<PointField> parsed_type(std::string_view type) {
  PointField field;
  const std::size_t bracket = type.find('[');
  if (bracket != std::string_view::npos) {
    if (!type.ends_with(']')) return std::nullopt;
    const auto count = parse_number<int>(type.substr(bracket + 1, type.size() - bracket - 2));
    if (!count || *count < 1 || *count > kLargestCount) return std::nullopt;
    field.count = *count;
    type = type.substr(0, bracket);
  }
  static constexpr std::string_view kTypes[] = {"f4", "f8", "i1", "i2", "i4",
                                                "i8", "u1", "u2", "u4", "u8"};
  if (std::find(std::begin(kTypes), std::end(kTypes), type) == std::end(kTypes)) {
    return std::nullopt;
  }
  field.type = static_cast<char>(type[0] - 'a' + 'A');
  field.size = type[1] - '0';
  return field;
}

}  // namespace

std::vector<PointField> point_layout_fields(std::string_view text) {
  std::vector<PointField> fields;
  std::unordered_set<std::string_view> names;
  if (text.find(',') != std::string_view::npos) {
    fail(text, ",", "stands between its fields, where blanks should be");
  }
  for (const std::string_view word : split_blanks(text)) {
    const std::string_view name = word.substr(0, word.find(':'));
    if (name.empty()) fail(text, word, "has no name");
    if (std::any_of(name.begin(), name.end(), is_unprinted)) {
      fail(text, word, "has a character that is not printed");
    }
    PointField field;
    if (name.size() != word.size()) {
      const auto typed = parsed_type(word.substr(name.size() + 1));
      if (!typed) fail(text, word, "has no known type");
      field = *typed;
    }
    if (name != "_" && !names.insert(name).second) fail(text, word, "stands there twice");
    field.name = name;
    fields.push_back(field);
  }
  return fields;
}

RecordLayout parse_point_layout(std::string_view text) {
  RecordLayout layout;
  for (const PointField& field : point_layout_fields(text)) {
    if (layout.row_bytes + field.bytes() > kLargestRow) {
      fail(text, field.name, "makes a point too large");
    }
    if (field.name == "_") {
      layout.row_bytes += field.bytes();
    } else {
      layout.add(field.name, field.type, field.size, field.count);
    }
  }
  for (const char* axis : {"x", "y", "z"}) {
    const PointField* field = layout.find({axis});
    if (field == nullptr || field->count != 1) fail(text, axis, "with one value is missing");
  }
  return layout;
}

std::string point_layout_text(const RecordLayout& layout) {
  NameRules rules;
  rules.taken = {"_"};
  std::vector<std::string> names = names_of(layout);
  // A colon ends a name.
  for (std::string& name : names) std::replace(name.begin(), name.end(), ':', '_');
  names = fitting_names(names, rules);
  std::string text;
  std::size_t at = 0;
  const auto fill = [&](std::size_t end) {
    if (end > at) text += (text.empty() ? "_:u1[" : " _:u1[") + std::to_string(end - at) + "]";
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PointField& field = layout.fields[i];
    fill(field.offset);
    text += (text.empty() ? "" : " ") + names[i];
    const bool usual = field.type == 'F' && field.size == 4 && field.count == 1;
    if (!usual) {
      text += std::string(":") + static_cast<char>(field.type - 'A' + 'a') +
              std::to_string(field.size) +
              (field.count == 1 ? "" : "[" + std::to_string(field.count) + "]");
    }
    at = field.offset + field.bytes();
  }
  fill(layout.row_bytes);
  return text;
}

RecordLayout bin_layout(const std::optional<std::string>& point_layout) {
  RecordLayout layout = parse_point_layout(point_layout.value_or("x y z intensity"));
  layout.unnamed = true;
  return layout;
}

}  // namespace raymoval
