// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/field_names.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {
namespace {

/// The first `bytes` of `text` at most; no character of several bytes is split.
std::string cut(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) --bytes;
  return text.substr(0, bytes);
}

std::string allowed_name(std::string name, const NameRules& rules) {
  if (!rules.with_blanks) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || is_unprinted(c); }, '_');
  }
  if (name.empty()) name = "field";
  return cut(name, rules.most_bytes);
}

/// Room for the '_' and the digits that are appended to a name.
constexpr std::size_t kSuffix = 6;

}  // namespace

bool is_unprinted(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == '\x7F';
}

std::vector<std::string> fitting_names(const std::vector<std::string>& wanted,
                                       const NameRules& rules) {
  std::unordered_set<std::string> used(rules.taken.begin(), rules.taken.end());
  // The first field with a valid name keeps it.
  std::vector<std::string> names;
  std::vector<bool> kept;
  for (const std::string& name : wanted) {
    names.push_back(allowed_name(name, rules));
    kept.push_back(names.back() == name && used.insert(name).second);
  }
  // The next number of each beginning: no candidate is tried twice.
  std::unordered_map<std::string, std::size_t> next;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (kept[i] || used.insert(names[i]).second) continue;
    const std::string begin = cut(names[i], rules.most_bytes - kSuffix);
    std::size_t& number = next[begin];
    do {
      names[i] = begin + "_" + std::to_string(++number);
    } while (!used.insert(names[i]).second);
  }
  return names;
}

std::vector<std::string> names_of(const RecordLayout& layout) {
  std::vector<std::string> names;
  for (const PointField& field : layout.fields) names.push_back(field.name);
  return names;
}

std::vector<std::string> value_names(const RecordLayout& layout) {
  std::vector<std::string> names;
  for (const PointField& field : layout.fields) {
    for (int at = 0; at < field.count; ++at) {
      names.push_back(field.count == 1 ? field.name : field.name + "_" + std::to_string(at));
    }
  }
  return names;
}

std::vector<std::string> renamed_sentences(const std::vector<std::string>& wanted,
                                           const std::vector<std::string>& names) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == names[i]) continue;
    sentences.push_back("The field '" + wanted[i] + "' is written as '" + names[i] + "'.");
  }
  return sentences;
}

std::vector<std::string> split_sentences(const RecordLayout& layout) {
  std::vector<std::string> sentences;
  for (const PointField& field : layout.fields) {
    if (field.count == 1) continue;
    sentences.push_back("The field '" + field.name + "' has " + std::to_string(field.count) +
                        " values, which are written as '" + field.name + "_0' to '" + field.name +
                        "_" + std::to_string(field.count - 1) + "'.");
  }
  return sentences;
}

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
    fail(text, ",", "is between its fields, where blanks should be");
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
    if (name != "_" && !names.insert(name).second) fail(text, word, "occurs twice");
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
