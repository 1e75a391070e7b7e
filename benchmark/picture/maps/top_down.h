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
};

/// Points seen from above: how many of each outcome fall into each pixel.
class TopDownRaster {
 public:
  /// @param resolution metres per pixel
  TopDownRaster(const WorldWindow& window, double resolution);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  void add(const Eigen::Vector3d& world, Outcome outcome);

  /// What a pixel shows: of its moving points, if at least a tenth as many move as stand, else of
  /// its static points, what became of most of them. An error wins a tie.
  /// @return false if no point is there
  [[nodiscard]] bool shown(int x, int y, Outcome& outcome) const;
  /// Colours of `shown`; kept static points in grey, the darker the more of them.
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

/// A bar of a round length of metres with its name, its left end at x, y.
void draw_scale_bar(Canvas& canvas, int x, int y, double resolution, int most_pixels);

/// Squares and names of the four outcomes in a line. @return its width
int draw_outcome_legend(Canvas& canvas, int x, int y, int size);

}  // namespace raymoval
