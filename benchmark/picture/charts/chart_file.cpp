// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/chart_file.h"

#include <cairo-pdf.h>
#include <librsvg/rsvg.h>

#include <memory>

#include "benchmark/picture/canvas/png_file.h"
#include "core/error.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

constexpr double kPixelsPerUnit = 2.0;    ///< Of a PNG: sharp when printed a few inches wide.
constexpr double kPointsPerPixel = 0.75;  ///< CSS: 96 pixels and 72 points to the inch.

struct FreeObject {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
template <class Object>
using Owned = std::unique_ptr<Object, FreeObject>;

/// A chart that librsvg can draw.
class DrawableChart {
 public:
  explicit DrawableChart(const std::string& svg) {
    GError* error = nullptr;
    const auto* bytes = reinterpret_cast<const guint8*>(svg.data());
    handle_.reset(rsvg_handle_new_from_data(bytes, svg.size(), &error));
    if (handle_ == nullptr) throw failure(error);
    if (rsvg_handle_get_intrinsic_size_in_pixels(handle_.get(), &width_, &height_) == 0) {
      throw InternalError("a chart has no size");
    }
  }
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

  /// @param factor units of the surface for each pixel of the chart
  void draw(cairo_surface_t* surface, double factor) const {
    const Owned<cairo_t> context(cairo_create(surface));
    const RsvgRectangle all{0.0, 0.0, width_ * factor, height_ * factor};
    GError* error = nullptr;
    if (rsvg_handle_render_document(handle_.get(), context.get(), &all, &error) == 0) {
      throw failure(error);
    }
    if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) {
      throw DataError(std::string("the chart cannot be drawn: ") +
                      cairo_status_to_string(cairo_status(context.get())));
    }
  }

 private:
  static DataError failure(GError* error) {
    const std::string text = error == nullptr ? "unknown error" : error->message;
    if (error != nullptr) g_error_free(error);
    return DataError("the chart cannot be drawn: " + text);
  }

  Owned<RsvgHandle> handle_;
  double width_ = 0.0, height_ = 0.0;
};

std::string pdf_bytes(const DrawableChart& chart) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  const Owned<cairo_surface_t> surface(cairo_pdf_surface_create_for_stream(
      append, &bytes, chart.width() * kPointsPerPixel, chart.height() * kPointsPerPixel));
  // Without this the hour of the drawing stands in the file.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  chart.draw(surface.get(), kPointsPerPixel);
  cairo_surface_finish(surface.get());
  return bytes;
}

RgbImage pixels_of(const DrawableChart& chart) {
  RgbImage image;
  image.width = static_cast<int>(chart.width() * kPixelsPerUnit + 0.5);
  image.height = static_cast<int>(chart.height() * kPixelsPerUnit + 0.5);
  const Owned<cairo_surface_t> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) {
    throw DataError("the chart is too large for a PNG (" + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " pixels); write it as .svg or .pdf");
  }
  chart.draw(surface.get(), kPixelsPerUnit);
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < image.height; ++y) {
    const auto* line =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < image.width; ++x) {
      for (const unsigned shift : {16U, 8U, 0U}) {
        image.rgb.push_back(static_cast<std::uint8_t>(line[x] >> shift & 0xFFU));
      }
    }
  }
  return image;
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
