// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "benchmark/picture/canvas/canvas.h"
#include "benchmark/picture/maps/point_outcome.h"

namespace raymoval {

/// A rectangle of the world, metres, x to the right and y up in pictures.
struct WorldWindow {
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;

  [[nodiscard]] double width() const { return x_max - x_min; }
  [[nodiscard]] double height() const { return y_max - y_min; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& at) const {
    return at.x() >= x_min && at.x() <= x_max && at.y() >= y_min && at.y() <= y_max;
  }
};

/// Points seen from above. It counts for each pixel how many points of each outcome lie in it.
class TopDownRaster {
 public:
  /// @param resolution metres per pixel
  TopDownRaster(const WorldWindow& window, double resolution);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  void add(const Eigen::Vector3d& world, Outcome outcome);

  /// What a pixel shows. If at least one point moves for every ten static ones, it is the outcome
  /// of most of the moving points, else that of most of the static ones. An error wins a tie.
  /// @return false if the pixel has no point
  [[nodiscard]] bool shown(int x, int y, Outcome& outcome) const;
  /// Draws the colours of `shown`. Kept static points are grey: the more of them, the darker.
  void draw(Canvas& canvas, int x, int y) const;

 private:
  using Counts = std::array<std::uint32_t, kOutcomes>;
  [[nodiscard]] const Counts& counts(int x, int y) const {
    return counts_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }

  WorldWindow window_;
  double resolution_;
  int width_, height_;
  std::vector<Counts> counts_;
};

/// Draws a bar whose length is a round number of metres, and writes that number above it.
/// @param x,y left end of the bar
/// @param resolution metres per pixel
void draw_scale_bar(Canvas& canvas, int x, int y, double resolution, int most_pixels);

/// Draws the colours and names of the four outcomes in a line. @return the width of the line
int draw_outcome_legend(Canvas& canvas, int x, int y, int size);

}  // namespace raymoval
