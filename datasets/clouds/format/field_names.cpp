// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/field_names.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace raymoval {
namespace {

/// At most `bytes` of `text`; no letter of several bytes is cut in two.
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

/// Room for the '_' and the digits that are put behind a name.
constexpr std::size_t kSuffix = 6;

}  // namespace

bool is_unprinted(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == '\x7F';
}

std::vector<std::string> fitting_names(const std::vector<std::string>& wanted,
                                       const NameRules& rules) {
  std::unordered_set<std::string> used(rules.taken.begin(), rules.taken.end());
  // A name that fits as it stands keeps it, wherever it stands.
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

}  // namespace raymoval
