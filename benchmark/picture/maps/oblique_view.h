// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/picture/canvas/canvas.h"
#include "benchmark/picture/maps/top_down.h"

namespace raymoval {

/// A camera that looks down on the world obliquely, without perspective. The view's own frame is
/// the world turned about z: x points to the right of the picture, y away from the viewer, z up.
struct ObliqueCamera {
  double yaw = 0.0;         ///< Turns the world's x axis away from the picture's right, radians.
  WorldWindow window;       ///< In the view's frame.
  double ground = 0.0;      ///< The world's z at which the window lies, metres.
  double headroom = 6.0;    ///< Metres above the window's far side that fit into the picture.
  double resolution = 0.1;  ///< Metres per pixel.

  [[nodiscard]] Eigen::Vector3d to_view(const Eigen::Vector3d& world) const;
  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  /// The pixel of a point of the view's frame, and its nearness, which grows towards the viewer.
  struct Place {
    double x, y, nearness;
  };
  [[nodiscard]] Place place(const Eigen::Vector3d& view) const;
};

/// Draws points so that near ones hide far ones. Of equally near ones the first stays.
class ObliqueRaster {
 public:
  explicit ObliqueRaster(const ObliqueCamera& camera);

  [[nodiscard]] const ObliqueCamera& camera() const { return camera_; }
  /// @param view in the view's frame
  /// @param size of the point in pixels
  void add(const Eigen::Vector3d& view, const Colour& colour, int size);
  void draw(Canvas& canvas, int x, int y) const;

 private:
  struct Pixel {
    float nearness;
    Colour colour;
    bool filled = false;
  };
  ObliqueCamera camera_;
  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace raymoval
