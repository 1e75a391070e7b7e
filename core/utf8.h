// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace raymoval {

/// Whether a character of a UTF-8 text begins with this byte.
constexpr bool begins_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

/// The number of characters of a UTF-8 text.
std::size_t character_count(const std::string& text);

/// The first `most` bytes of a UTF-8 text, or a few less, so that no character is split.
std::string cut_text(const std::string& text, std::size_t most);

/// The text as valid UTF-8 that can be shown: ASCII's control characters become blanks. Bytes that
/// are no UTF-8, other control characters, invisible characters and changes of the direction of
/// writing become U+FFFD.
std::string printable_text(const std::string& text);

/// `printable_text` for XML or HTML, also within quotes: '&', '<', '>' and '"' are escaped.
std::string xml_escaped(const std::string& text);

/// Text for an id of XML or HTML: letters and digits stay, and all else becomes '-'.
std::string id_text(std::string text);

}  // namespace raymoval
