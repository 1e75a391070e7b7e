// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/canvas.h"

#include <cairo-ft.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

cairo_surface_t* image_surface(int width, int height) {
  const long pixels = static_cast<long>(width) * height;
  if (width < 1 || height < 1 || pixels > Canvas::kMostPixels) {
    throw UsageError(
        fmt::format("the picture would have {} x {} pixels; at most {} are drawn. Choose fewer "
                    "cells with --only, a coarser --resolution or a smaller --crop.",
                    width, height, grouped_text(Canvas::kMostPixels)));
  }
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
}

/// The pixels of a row: red, green and blue in the three lower bytes of each.
std::uint32_t* row_of(cairo_surface_t* surface, int y) {
  unsigned char* data = cairo_image_surface_get_data(surface);
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface);
  return reinterpret_cast<std::uint32_t*>(data + y * stride);
}

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
  // Both live until the program ends, because cairo reads letters from them at any time.
  static FT_Library library = nullptr;
  FT_Face face = nullptr;
  if ((library == nullptr && FT_Init_FreeType(&library) != 0) ||
      FT_New_Face(library, file.c_str(), 0, &face) != 0) {
    throw ConfigurationError(
        fmt::format("{}: cannot be read as a font; expected a TrueType file.", file));
  }
  return cairo_ft_font_face_create_for_ft_face(face, FT_LOAD_TARGET_LIGHT);
}

/// Makes `context` write in DejaVu Sans, from the file of $RAYMOVAL_FONT or from the usual font
/// folders. The file is read once per process. fontconfig is not used, so that the same file gives
/// the same picture on every system.
void choose_font(cairo_t* context, int size) {
  static cairo_font_face_t* const regular = load_font(font_file());
  const std::unique_ptr<cairo_font_options_t, void (*)(cairo_font_options_t*)> options(
      cairo_font_options_create(), cairo_font_options_destroy);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_SLIGHT);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_set_font_face(context, regular);
  cairo_set_font_options(context, options.get());
  cairo_set_font_size(context, size);
}

void set_source(cairo_t* context, const Colour& colour) {
  cairo_set_source_rgb(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

}  // namespace

void CairoRelease::operator()(_cairo* context) const {
  cairo_destroy(context);
}

void CairoRelease::operator()(_cairo_surface* surface) const {
  cairo_surface_destroy(surface);
}

Canvas::Canvas(int width, int height)
    : surface_(image_surface(width, height)), context_(cairo_create(surface_.get())) {
  if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  fill(0, 0, width, height, kPaper);
}

int Canvas::width() const {
  return cairo_image_surface_get_width(surface_.get());
}

int Canvas::height() const {
  return cairo_image_surface_get_height(surface_.get());
}

Colour Canvas::at(int x, int y) const {
  cairo_surface_flush(surface_.get());
  const std::uint32_t pixel = row_of(surface_.get(), y)[x];
  return {static_cast<std::uint8_t>(pixel >> 16U), static_cast<std::uint8_t>(pixel >> 8U),
          static_cast<std::uint8_t>(pixel)};
}

void Canvas::fill(int x, int y, int wide, int high, const Colour& colour) {
  set_source(context(), colour);
  cairo_rectangle(context(), x, y, wide, high);
  cairo_fill(context());
}

void Canvas::frame(int x, int y, int wide, int high, const Colour& colour) {
  set_source(context(), colour);
  cairo_set_line_width(context(), 1.0);
  cairo_rectangle(context(), x + 0.5, y + 0.5, wide - 1, high - 1);
  cairo_stroke(context());
}

void Canvas::draw_pixels(int x, int y, int wide, int high,
                         const std::function<std::optional<Colour>(int, int)>& colour_at) {
  cairo_surface_flush(surface_.get());
  for (int row = std::max(0, -y); row < std::min(high, height() - y); ++row) {
    std::uint32_t* pixels = row_of(surface_.get(), y + row);
    for (int column = std::max(0, -x); column < std::min(wide, width() - x); ++column) {
      const std::optional<Colour> colour = colour_at(column, row);
      if (!colour) continue;
      pixels[x + column] = std::uint32_t{colour->red} << 16U | std::uint32_t{colour->green} << 8U |
                           std::uint32_t{colour->blue};
    }
  }
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::hatch(int x, int y, int wide, int high) {
  constexpr int kPeriod = 14;
  draw_pixels(x, y, wide, high, [](int column, int row) {
    const bool stripe = (row + column) % kPeriod < 3;
    return stripe ? Colour{214, 214, 214} : Colour{246, 246, 246};
  });
}

int Canvas::text_width(const std::string& text, int size) const {
  choose_font(context(), size);
  cairo_text_extents_t extents{};  // Unchanged if memory runs out.
  cairo_text_extents(context(), printable_text(text).c_str(), &extents);
  return static_cast<int>(std::ceil(extents.x_advance));
}

void Canvas::text(int x, int y, const std::string& text, int size, const Colour& colour,
                  Align align) {
  const int width = text_width(text, size);  // Chooses the font, too.
  const int before = align == Align::kLeft ? 0 : align == Align::kCentre ? width / 2 : width;
  set_source(context(), colour);
  cairo_move_to(context(), x - before, y);
  cairo_show_text(context(), printable_text(text).c_str());
}

std::string Canvas::fitted(const std::string& text, int size, int most) const {
  if (text_width(text, size) <= most) return text;
  std::string begin = text;
  while (!begin.empty() && text_width(begin + "...", size) > most) {
    begin = cut_text(begin, begin.size() - 1);
  }
  return begin + "...";
}

std::string Canvas::png_bytes() const {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_status_t status = cairo_status(context());
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(cairo_get_target(context()), append, &bytes);
  }
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InternalError(
        fmt::format("a picture cannot be encoded: {}", cairo_status_to_string(status)));
  }
  return bytes;
}

}  // namespace raymoval
