// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/error.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

constexpr const char* kPlaces[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                   "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                   "/usr/share/fonts/TTF/DejaVuSans.ttf",
                                   "/usr/share/fonts/dejavu/DejaVuSans.ttf"};

std::string font_file() {
  if (const char* given = std::getenv("RAYMOVAL_FONT"); given != nullptr && *given != '\0') {
    return given;
  }
  for (const char* place : kPlaces) {
    if (is_file(place)) return place;
  }
  throw ConfigurationError(
      "pictures need the font DejaVu Sans, which was not found. Install it (Debian: "
      "fonts-dejavu-core), or name a TrueType file in RAYMOVAL_FONT.");
}

/// Code points of UTF-8; a byte that belongs to none becomes U+FFFD.
std::vector<std::uint32_t> code_points(const std::string& text) {
  std::vector<std::uint32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first < 0x80    ? 0
                     : first >= 0xF0 ? 3
                     : first >= 0xE0 ? 2
                     : first >= 0xC0 ? 1
                                     : -1;
    std::uint32_t code = more <= 0 ? first : first & (0x3FU >> more);
    int left = more;
    while (left > 0 && i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U) {
      code = code << 6U | (static_cast<unsigned char>(text[i++]) & 0x3FU);
      --left;
    }
    codes.push_back(left == 0 && code >= 0x20 ? code : 0xFFFDU);
  }
  return codes;
}

}  // namespace

struct Font::Library {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ~Library() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }

  /// Loads a glyph; false if the font cannot give it.
  bool load(std::uint32_t code, int size, bool render) const {
    if (FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size)) != 0) return false;
    const FT_Int32 flags = FT_LOAD_TARGET_LIGHT | (render ? FT_LOAD_RENDER : 0);
    return FT_Load_Char(face, code, flags) == 0;
  }
};

Font::Font() : library_(std::make_unique<Library>()) {
  const std::string file = font_file();
  if (FT_Init_FreeType(&library_->library) != 0 ||
      FT_New_Face(library_->library, file.c_str(), 0, &library_->face) != 0) {
    throw ConfigurationError(file + ": is no font that can be read; expected a TrueType file.");
  }
}

Font::~Font() = default;

int Font::width(const std::string& text, int size) const {
  long advance = 0;  // In 64ths of a pixel.
  for (const std::uint32_t code : code_points(text)) {
    if (library_->load(code, size, false)) advance += library_->face->glyph->advance.x;
  }
  return static_cast<int>((advance + 63) / 64);
}

TextBitmap Font::draw(const std::string& text, int size) const {
  TextBitmap bitmap;
  bitmap.width = width(text, size) + 2;
  bitmap.height = size * 3 / 2;
  bitmap.baseline = size * 11 / 10;
  bitmap.coverage.resize(static_cast<std::size_t>(bitmap.width * bitmap.height));
  long pen = 0;
  for (const std::uint32_t code : code_points(text)) {
    if (!library_->load(code, size, true)) continue;
    const FT_GlyphSlot glyph = library_->face->glyph;
    const int left = static_cast<int>(pen / 64) + glyph->bitmap_left;
    const int top = bitmap.baseline - glyph->bitmap_top;
    for (int row = 0; row < static_cast<int>(glyph->bitmap.rows); ++row) {
      for (int column = 0; column < static_cast<int>(glyph->bitmap.width); ++column) {
        const int x = left + column, y = top + row;
        if (x < 0 || y < 0 || x >= bitmap.width || y >= bitmap.height) continue;
        std::uint8_t& covered = bitmap.coverage[static_cast<std::size_t>(y * bitmap.width + x)];
        covered = std::max(covered, glyph->bitmap.buffer[row * glyph->bitmap.pitch + column]);
      }
    }
    pen += glyph->advance.x;
  }
  return bitmap;
}

std::string Font::fitted(const std::string& text, int size, int most) const {
  if (width(text, size) <= most) return text;
  std::string begin = text;
  while (!begin.empty() && width(begin + "...", size) > most) {
    while (begin.size() > 1 && (static_cast<unsigned char>(begin.back()) & 0xC0U) == 0x80U) {
      begin.pop_back();
    }
    begin.pop_back();
  }
  return begin + "...";
}

}  // namespace raymoval
