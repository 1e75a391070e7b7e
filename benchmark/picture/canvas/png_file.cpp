// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/png_file.h"

#include <cairo.h>
#include <fmt/format.h>

#include <cstring>
#include <new>
#include <span>

#include "core/error.h"
#include "core/files/files.h"

namespace raymoval {

std::string png_bytes(const Canvas& canvas) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_status_t status = cairo_status(canvas.context());
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(cairo_get_target(canvas.context()), append, &bytes);
  }
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InternalError(
        fmt::format("a picture cannot be coded: {}", cairo_status_to_string(status)));
  }
  return bytes;
}

void write_png(const std::filesystem::path& path, const Canvas& canvas) {
  write_atomically(path, png_bytes(canvas));
}

Canvas read_png(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  std::span<const std::byte> rest(bytes);
  const auto take = [](void* from, unsigned char* to, unsigned int length) {
    auto& left = *static_cast<std::span<const std::byte>*>(from);
    if (left.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(to, left.data(), length);
    left = left.subspan(length);
    return CAIRO_STATUS_SUCCESS;
  };
  const std::unique_ptr<cairo_surface_t, CairoRelease> surface(
      cairo_image_surface_create_from_png_stream(take, &rest));
  const cairo_status_t status = cairo_surface_status(surface.get());
  // Cairo tells what libpng refuses as a lack of memory, so the two cannot be told apart.
  if (status != CAIRO_STATUS_SUCCESS) {
    throw DataError(fmt::format("{}: not a PNG file, or too large for the memory ({}).",
                                path.string(), cairo_status_to_string(status)));
  }
  Canvas canvas(cairo_image_surface_get_width(surface.get()),
                cairo_image_surface_get_height(surface.get()));
  cairo_set_source_surface(canvas.context(), surface.get(), 0.0, 0.0);
  cairo_paint(canvas.context());
  return canvas;
}

}  // namespace raymoval
