// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/oblique_view.h"

#include <algorithm>
#include <cmath>

namespace raymoval {
namespace {

// The camera looks down by 42 degrees.
constexpr double kSine = 0.6691306063588582;
constexpr double kCosine = 0.7431448254773942;

}  // namespace

Eigen::Vector3d ObliqueCamera::to_view(const Eigen::Vector3d& world) const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * world.x() + s * world.y(), c * world.y() - s * world.x(), world.z()};
}

int ObliqueCamera::width() const {
  return std::max(1, static_cast<int>(std::lround(window.width() / resolution)));
}

int ObliqueCamera::height() const {
  const double high = window.height() * kSine + headroom * kCosine;
  return std::max(1, static_cast<int>(std::lround(high / resolution)));
}

ObliqueCamera::Place ObliqueCamera::place(const Eigen::Vector3d& view) const {
  const double up = (view.y() - window.y_min) * kSine + (view.z() - ground) * kCosine;
  return {(view.x() - window.x_min) / resolution, height() - up / resolution,
          (view.z() - ground) * kSine - (view.y() - window.y_min) * kCosine};
}

ObliqueRaster::ObliqueRaster(const ObliqueCamera& camera)
    : camera_(camera),
      width_(camera.width()),
      height_(camera.height()),
      pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void ObliqueRaster::add(const Eigen::Vector3d& view, const Colour& colour, int size) {
  if (view.x() < camera_.window.x_min || view.x() >= camera_.window.x_max ||
      view.y() < camera_.window.y_min || view.y() >= camera_.window.y_max) {
    return;
  }
  const ObliqueCamera::Place place = camera_.place(view);
  const auto nearness = static_cast<float>(place.nearness);
  const int left = static_cast<int>(std::floor(place.x)),
            top = static_cast<int>(std::floor(place.y));
  for (int y = std::max(0, top); y < std::min(height_, top + size); ++y) {
    for (int x = std::max(0, left); x < std::min(width_, left + size); ++x) {
      Pixel& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                             static_cast<std::size_t>(x)];
      if (pixel.filled && !(nearness > pixel.nearness)) continue;
      pixel = {nearness, colour, true};
    }
  }
}

void ObliqueRaster::draw(Canvas& canvas, int left, int top) const {
  canvas.draw_pixels(left, top, width_, height_, [&](int x, int y) -> std::optional<Colour> {
    const Pixel& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                 static_cast<std::size_t>(x)];
    return pixel.filled ? std::optional(pixel.colour) : std::nullopt;
  });
}

}  // namespace raymoval
