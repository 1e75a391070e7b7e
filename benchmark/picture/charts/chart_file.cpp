// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/chart_file.h"

#include <cairo-pdf.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

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

struct RsvgRelease {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
};

/// A chart that librsvg can draw.
class DrawableChart {
 public:
  explicit DrawableChart(const std::string& svg) {
    GError* error = nullptr;
    const auto* bytes = reinterpret_cast<const guint8*>(svg.data());
    handle_.reset(rsvg_handle_new_from_data(bytes, svg.size(), &error));
    if (handle_ == nullptr) throw failure(message_of(error));
    if (rsvg_handle_get_intrinsic_size_in_pixels(handle_.get(), &width_, &height_) == 0) {
      throw InternalError("a chart has no size");
    }
  }
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

  /// @param factor units of what is drawn on for each pixel of the chart
  void draw(cairo_t* context, double factor) const {
    const RsvgRectangle all{0.0, 0.0, width_ * factor, height_ * factor};
    GError* error = nullptr;
    if (rsvg_handle_render_document(handle_.get(), context, &all, &error) == 0) {
      throw failure(message_of(error));
    }
    const cairo_status_t status = cairo_status(context);
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS) throw failure(cairo_status_to_string(status));
  }

 private:
  static DataError failure(const std::string& reason) {
    return DataError("the chart cannot be drawn: " + reason);
  }
  static std::string message_of(GError* error) {
    const std::unique_ptr<GError, void (*)(GError*)> owned(error, g_error_free);
    return error == nullptr ? "unknown error" : error->message;
  }

  std::unique_ptr<RsvgHandle, RsvgRelease> handle_;
  double width_ = 0.0, height_ = 0.0;
};

std::string pdf_bytes(const DrawableChart& chart) {
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
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) {
    throw DataError(std::string("the chart cannot be coded: ") + cairo_status_to_string(status));
  }
  return bytes;
}

Canvas pixels_of(const DrawableChart& chart) {
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
  return canvas;
}

}  // namespace

const std::vector<std::string>& chart_extensions() {
  static const std::vector<std::string> extensions = {".svg", ".pdf", ".png"};
  return extensions;
}

void write_chart(const std::filesystem::path& path, const DrawChart& draw) {
  if (path.extension() == ".svg") return write_atomically(path, draw(ChartPlace::kFile));
  const DrawableChart chart(draw(ChartPlace::kPrint));
  if (path.extension() == ".png") return write_png(path, pixels_of(chart));
  write_atomically(path, pdf_bytes(chart));
}

}  // namespace raymoval
