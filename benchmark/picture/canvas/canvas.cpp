// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/canvas.h"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "benchmark/picture/canvas/font.h"
#include "core/error.h"
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

}  // namespace

void set_source(_cairo* context, const Colour& colour) {
  cairo_set_source_rgb(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

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
  cairo_text_extents_t extents{};  // Is left alone if there is no memory.
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

/// Words in lines that are no wider than `width`.
std::vector<std::string> Canvas::broken(const std::string& text, int size, int width) const {
  std::vector<std::string> lines;
  for (const std::string_view word : split_blanks(text)) {
    const std::string longer =
        lines.empty() ? std::string(word) : lines.back() + " " + std::string(word);
    if (!lines.empty() && text_width(longer, size) <= width) {
      lines.back() = longer;
    } else {
      lines.push_back(fitted(std::string(word), size, width));
    }
  }
  return lines;
}

void Canvas::paragraph(int x, int y, int wide, int high, const std::string& text, int size,
                       const Colour& colour) {
  const int pitch = size * 4 / 3;
  std::vector<std::string> lines = broken(text, size, wide);
  const auto most = static_cast<std::size_t>(std::max(1, high / pitch));
  if (lines.size() > most) {
    lines.resize(most);
    lines.back() += " ...";
  }
  const int total = pitch * static_cast<int>(lines.size());
  int widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, text_width(line, size));
  // Plain ground below, so that the words can be read on a hatched one.
  const int top = y + (high - total) / 2;
  fill(x + (wide - widest) / 2 - 6, top - 4, widest + 12, total + 8, kPaper);
  int baseline = top + size;
  for (const std::string& line : lines) {
    this->text(x + wide / 2, baseline, line, size, colour, Align::kCentre);
    baseline += pitch;
  }
}

}  // namespace raymoval
