// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/font.h"

#include <cairo-ft.h>
#include <fmt/format.h>

#include <cstdlib>
#include <memory>

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

cairo_font_face_t* load_font(const std::string& file) {
  // Both stay until the program ends: cairo reads letters from them whenever it needs one.
  static FT_Library library = nullptr;
  FT_Face face = nullptr;
  if ((library == nullptr && FT_Init_FreeType(&library) != 0) ||
      FT_New_Face(library, file.c_str(), 0, &face) != 0) {
    throw ConfigurationError(
        fmt::format("{}: is no font that can be read; expected a TrueType file.", file));
  }
  return cairo_ft_font_face_create_for_ft_face(face, FT_LOAD_TARGET_LIGHT);
}

cairo_font_face_t* bold_font(cairo_font_face_t* other) {
  const std::string file = font_file();
  const std::string bold = file.substr(0, file.rfind('.')) + "-Bold.ttf";
  return is_file(bold) ? load_font(bold) : other;
}

}  // namespace

void choose_font(_cairo* context, int size, bool bold) {
  static cairo_font_face_t* const regular = load_font(font_file());
  static cairo_font_face_t* const heavy = bold_font(regular);
  const std::unique_ptr<cairo_font_options_t, void (*)(cairo_font_options_t*)> options(
      cairo_font_options_create(), cairo_font_options_destroy);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_SLIGHT);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_set_font_face(context, bold ? heavy : regular);
  cairo_set_font_options(context, options.get());
  cairo_set_font_size(context, size);
}

}  // namespace raymoval
