// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/chart_file.h"

#include <cairo-pdf.h>
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <new>

#include "benchmark/picture/canvas/png_file.h"
#include "core/error.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

constexpr double kPixelsPerUnit = 2.0;  ///< Pixels of a PNG: sharp when printed a few inches wide.
constexpr double kPointsPerPixel = 0.75;  ///< CSS: 96 pixels and 72 points to the inch.

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) {
    throw DataError(fmt::format("the chart cannot be drawn: {}", cairo_status_to_string(status)));
  }
}

std::string pdf_bytes(const ChartDrawing& chart) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  const std::unique_ptr<cairo_surface_t, CairoRelease> surface(cairo_pdf_surface_create_for_stream(
      append, &bytes, chart.width() * kPointsPerPixel, chart.height() * kPointsPerPixel));
  // Without this the hour of the drawing stands in the file.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  const std::unique_ptr<cairo_t, CairoRelease> context(cairo_create(surface.get()));
  chart.draw(context.get(), kPointsPerPixel);
  check(cairo_status(context.get()));
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return bytes;
}

Canvas pixels_of(const ChartDrawing& chart) {
  const double width = std::floor(chart.width() * kPixelsPerUnit + 0.5);
  const double height = std::floor(chart.height() * kPixelsPerUnit + 0.5);
  if (width * height > static_cast<double>(Canvas::kMostPixels)) {
    throw DataError(
        fmt::format("the chart is too large for a PNG ({:.0f} x {:.0f} pixels); write it as .svg "
                    "or .pdf",
                    width, height));
  }
  Canvas canvas(static_cast<int>(width), static_cast<int>(height));
  chart.draw(canvas.context(), kPixelsPerUnit);
  check(cairo_status(canvas.context()));
  return canvas;
}

}  // namespace

const std::vector<std::string>& chart_extensions() {
  static const std::vector<std::string> extensions = {".svg", ".pdf", ".png"};
  return extensions;
}

void write_chart(const std::filesystem::path& path, const ChartDrawing& chart) {
  if (path.extension() == ".svg") return write_atomically(path, chart.svg());
  if (path.extension() == ".png") return write_png(path, pixels_of(chart));
  write_atomically(path, pdf_bytes(chart));
}

}  // namespace raymoval
