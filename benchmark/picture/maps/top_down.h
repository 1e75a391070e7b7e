// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/picture/canvas/canvas.h"
#include "core/scan/mask_store.h"
#include "datasets/sequence.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// The verdict on a point.
enum class Outcome : std::uint8_t {
  kKeptStatic,
  kTruePositive,   ///< Moving and removed.
  kFalsePositive,  ///< Static and removed.
  kFalseNegative,  ///< Moving and kept.
};
inline constexpr std::size_t kOutcomes = 4;

Colour outcome_colour(Outcome outcome);
/// The name in legends, such as "moving, removed".
const char* outcome_name(Outcome outcome);
/// The outcomes in the order of legends.
inline constexpr std::array<Outcome, kOutcomes> kLegendOrder = {
    Outcome::kTruePositive, Outcome::kFalsePositive, Outcome::kFalseNegative, Outcome::kKeptStatic};

constexpr Outcome outcome_of(bool moving, bool removed) {
  if (moving) return removed ? Outcome::kTruePositive : Outcome::kFalseNegative;
  return removed ? Outcome::kFalsePositive : Outcome::kKeptStatic;
}

/// A shown point with its verdict.
struct PointOutcome {
  Eigen::Vector3d world;  ///< In the frame of the scans, metres.
  Outcome outcome;
};
/// Receives a point once for each of the masks, with the number of the mask.
using VisitPoint = std::function<void(std::size_t mask, const PointOutcome& point)>;

/// Visits, scan by scan, the points of a sequence that protocols evaluate by default. They are in
/// range, their label is not ignored, and they are not on the ego vehicle (within 2.7 m of the
/// sensor's axis).
/// @param scans of the sequence, in a frame whose z axis points up
/// @param masks the masks of the methods
/// @param task the text of the progress
/// @throws Cancelled
void for_each_shown_point(const Sequence& sequence, const ScanSource& scans,
                          const std::vector<MaskStore>& masks, const std::string& task,
                          const OpenContext& context, const VisitPoint& visit);

/// A rectangle of the world, metres, x to the right and y up in pictures.
struct WorldWindow {
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;

  [[nodiscard]] double width() const { return x_max - x_min; }
  [[nodiscard]] double height() const { return y_max - y_min; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& at) const {
    return at.x() >= x_min && at.x() <= x_max && at.y() >= y_min && at.y() <= y_max;
  }
};

/// The window with `around` metres on each side of the places; around the origin if there are none.
WorldWindow window_around(const std::vector<Eigen::Vector3d>& places, double around);

/// Points seen from above. It counts for each pixel how many points of each outcome lie in it.
class TopDownRaster {
 public:
  /// @param resolution metres per pixel
  TopDownRaster(const WorldWindow& window, double resolution);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  void add(const Eigen::Vector3d& world, Outcome outcome);

  /// The outcome of a pixel: if at least one point moves for every ten static points, that of most
  /// moving points, else that of most static points. In a tie the error is shown.
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
