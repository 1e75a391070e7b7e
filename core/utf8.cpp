// SPDX-License-Identifier: MIT
#include "core/utf8.h"

#include <algorithm>
#include <cstdint>

namespace raymoval {
namespace {

/// Whether a character controls a terminal, changes the direction of writing, or has no width: text
/// with it looks like other text.
bool is_treacherous(std::uint32_t code) {
  const auto within = [code](std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
  };
  return within(0x80, 0x9F) || code == 0xAD || code == 0x61C || within(0x200B, 0x200F) ||
         within(0x2028, 0x202E) || within(0x2060, 0x206F) || code == 0xFEFF ||
         within(0xFFF9, 0xFFFB) || within(0xE0000, 0xE007F);
}

/// Bytes of the UTF-8 sequence that starts at `at`; 0 if it is not to be shown: no UTF-8, a control
/// character, or what XML may not hold.
std::size_t sequence_length(const std::string& text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : (first >= 0xE0 ? 3 : 2);
  if (first < 0xC2 || first > 0xF4 || at + length > text.size()) return 0;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (begins_character(text[at + i])) return 0;
    code = code << 6U | (static_cast<unsigned char>(text[at + i]) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool allowed = code <= 0x10FFFF && (code & 0xFFFEU) != 0xFFFEU && !is_treacherous(code);
  return overlong || surrogate || !allowed ? 0 : length;
}

}  // namespace

std::size_t character_count(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

std::string cut_text(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && !begins_character(text[most])) --most;
  return text.substr(0, most);
}

std::string printable_text(const std::string& text) {
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text, at);
    if (length == 0) {
      shown += static_cast<unsigned char>(text[at]) < 0x20 ? " " : "\xEF\xBF\xBD";
    } else {
      shown.append(text, at, length);
    }
    at += std::max<std::size_t>(length, 1);
  }
  return shown;
}

std::string xml_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : printable_text(text)) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string id_text(std::string text) {
  for (char& c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (!plain) c = '-';
  }
  return text;
}

}  // namespace raymoval
