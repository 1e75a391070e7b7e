// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/map_picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/error.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "eval/columns/removal_tally.h"

namespace raymoval {
namespace {

constexpr int kOverviewMargin = 20;
constexpr int kOverviewHeading = 28;
constexpr int kOverviewGap = 16;
constexpr double kOverviewAround = 20.0;
constexpr double kLeastAspect = 0.30;  ///< Least ratio of height to width of the maps.
constexpr double kMostAboveSensor = 4.0;
constexpr double kZoomSide = 26.0;
constexpr double kCell = 4.0;  ///< Of the grid that finds the busiest place, metres.

// The camera looks down by 42 degrees.
constexpr double kSine = 0.6691306063588582;
constexpr double kCosine = 0.7431448254773942;

/// A camera that looks down on the world obliquely, without perspective. The view's own frame is
/// the world turned about z: x points to the right of the picture, y away from the viewer, z up.
struct ObliqueCamera {
  double yaw = 0.0;         ///< Turns the world's x axis away from the picture's right, radians.
  WorldWindow window;       ///< In the view's frame.
  double ground = 0.0;      ///< The world's z at which the window lies, metres.
  double headroom = 6.0;    ///< Metres above the window's far side that fit into the picture.
  double resolution = 0.1;  ///< Metres per pixel.

  [[nodiscard]] Eigen::Vector3d to_view(const Eigen::Vector3d& world) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {c * world.x() + s * world.y(), c * world.y() - s * world.x(), world.z()};
  }
  [[nodiscard]] int width() const {
    return std::max(1, static_cast<int>(std::lround(window.width() / resolution)));
  }
  [[nodiscard]] int height() const {
    const double high = window.height() * kSine + headroom * kCosine;
    return std::max(1, static_cast<int>(std::lround(high / resolution)));
  }
  /// The pixel of a point of the view's frame, and its nearness, which grows towards the viewer.
  struct Place {
    double x, y, nearness;
  };
  [[nodiscard]] Place place(const Eigen::Vector3d& view) const {
    const double up = (view.y() - window.y_min) * kSine + (view.z() - ground) * kCosine;
    return {(view.x() - window.x_min) / resolution, height() - up / resolution,
            (view.z() - ground) * kSine - (view.y() - window.y_min) * kCosine};
  }
};

/// Draws points so that near ones hide far ones. Of equally near points the first is kept.
class ObliqueRaster {
 public:
  explicit ObliqueRaster(const ObliqueCamera& camera)
      : camera_(camera),
        width_(camera.width()),
        height_(camera.height()),
        pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  [[nodiscard]] const ObliqueCamera& camera() const { return camera_; }
  /// @param view in the view's frame
  /// @param size of the point in pixels
  void add(const Eigen::Vector3d& view, const Colour& colour, int size) {
    const WorldWindow& window = camera_.window;
    if (!window.contains(view) || view.x() >= window.x_max || view.y() >= window.y_max) return;
    const ObliqueCamera::Place place = camera_.place(view);
    const auto nearness = static_cast<float>(place.nearness);
    const int left = static_cast<int>(std::floor(place.x)),
              top = static_cast<int>(std::floor(place.y));
    for (int y = std::max(0, top); y < std::min(height_, top + size); ++y) {
      for (int x = std::max(0, left); x < std::min(width_, left + size); ++x) {
        Pixel& pixel = pixels_[index(x, y)];
        if (pixel.filled && !(nearness > pixel.nearness)) continue;
        pixel = {nearness, colour, true};
      }
    }
  }
  void draw(Canvas& canvas, int left, int top) const {
    canvas.draw_pixels(left, top, width_, height_, [&](int x, int y) {
      const Pixel& pixel = pixels_[index(x, y)];
      return pixel.filled ? std::optional(pixel.colour) : std::nullopt;
    });
  }

 private:
  struct Pixel {
    float nearness;
    Colour colour;
    bool filled = false;
  };
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  ObliqueCamera camera_;
  int width_, height_;
  std::vector<Pixel> pixels_;
};

/// Calls `look` for each point that the overview shows.
void for_each_point(const Sequence& sequence, const ScanSource& scans,
                    const std::vector<MaskStore>& masks, const char* task,
                    const OpenContext& context,
                    const std::function<void(const PointOutcome&)>& look) {
  for_each_shown_point(sequence, scans, masks, task, context,
                       [&](std::size_t, const PointOutcome& point) {
                         if (point.above_sensor <= kMostAboveSensor) look(point);
                       });
}

/// The rotation that makes the sensor's path run from left to right. Without a path, the world's x
/// axis runs from left to right.
double yaw_of_way(const ScanSource& scans) {
  const Eigen::Vector3d from = scans.pose(0).translation();
  Eigen::Vector3d farthest = from;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Eigen::Vector3d at = scans.pose(i).translation();
    if ((at - from).head<2>().norm() > (farthest - from).head<2>().norm()) farthest = at;
  }
  const Eigen::Vector3d way = farthest - from;
  return way.head<2>().norm() > 1.0 ? std::atan2(way.y(), way.x()) : 0.0;
}

ObliqueCamera camera_of(const ScanSource& scans, const OverviewOptions& options) {
  ObliqueCamera camera;
  camera.ground = scans.pose(0).translation().z() - kHeightOffset;
  if (options.crop) {
    camera.window = *options.crop;
  } else {
    camera.yaw = yaw_of_way(scans);
    std::vector<Eigen::Vector3d> places;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      places.push_back(camera.to_view(scans.pose(i).translation()));
    }
    WorldWindow& window = camera.window;
    window = window_around(places, kOverviewAround);
    const double lacking = kLeastAspect * window.width() - window.height();
    window.y_min -= std::max(0.0, lacking) / 2.0;
    window.y_max += std::max(0.0, lacking) / 2.0;
  }
  camera.resolution = camera.window.width() / options.panel_pixels;
  // The two maps are one above the other.
  const double too_high = 2.0 * camera.height() / options.panel_pixels;
  if (too_high > 1.0) camera.resolution *= too_high;
  return camera;
}

/// The square of the view's frame in which most moving points were removed. If none was removed
/// anywhere, it is the square with most moving points; if nothing moves, the middle.
WorldWindow busiest_place(const Sequence& sequence, const ScanSource& scans,
                          const std::vector<MaskStore>& masks, const ObliqueCamera& camera,
                          const OpenContext& context) {
  std::map<std::pair<int, int>, double> cells;
  const auto cell_of = [](double metres) { return static_cast<int>(std::floor(metres / kCell)); };
  for_each_point(sequence, scans, masks, "reading the removals", context,
                 [&](const PointOutcome& point) {
                   const Eigen::Vector3d at = camera.to_view(point.world);
                   if (!camera.window.contains(at)) return;
                   double& cell = cells[{cell_of(at.x()), cell_of(at.y())}];
                   if (point.outcome == Outcome::kTruePositive) cell += 1.0;
                   if (point.outcome == Outcome::kFalseNegative) cell += 1e-6;
                 });
  const int reach = static_cast<int>(kZoomSide / kCell / 2.0);
  double most = 0.0;
  double x = (camera.window.x_min + camera.window.x_max) / 2.0;
  double y = (camera.window.y_min + camera.window.y_max) / 2.0;
  for (const auto& [at, unused] : cells) {
    double sum = 0.0;
    for (const auto& [other, points] : cells) {
      const int off =
          std::max(std::abs(other.first - at.first), std::abs(other.second - at.second));
      if (off < reach) sum += points;
    }
    if (sum <= most) continue;
    most = sum;
    x = (at.first + 0.5) * kCell;
    y = (at.second + 0.5) * kCell;
  }
  const auto within = [](double at, double low, double high) {
    const double side = std::min(kZoomSide, high - low);
    const double from = std::clamp(at - side / 2.0, low, high - side);
    return std::pair(from, from + side);
  };
  const auto [x_min, x_max] = within(x, camera.window.x_min, camera.window.x_max);
  const auto [y_min, y_max] = within(y, camera.window.y_min, camera.window.y_max);
  return {x_min, x_max, y_min, y_max};
}

/// Points on the ground are light, points above it dark.
Colour static_colour(double above_sensor) {
  return blended({206, 208, 212}, {92, 98, 112}, (above_sensor + 1.6) / 4.5);
}

/// The three views.
struct Views {
  ObliqueRaster raw, cleaned, zoom;
  std::uint64_t points = 0, within = 0, moving = 0, removed = 0, wrong = 0, left = 0;

  void add(const PointOutcome& point) {
    const bool moves =
        point.outcome == Outcome::kTruePositive || point.outcome == Outcome::kFalseNegative;
    const bool gone =
        point.outcome == Outcome::kTruePositive || point.outcome == Outcome::kFalsePositive;
    ++points;
    moving += moves ? 1 : 0;
    removed += gone ? 1 : 0;
    wrong += point.outcome == Outcome::kFalsePositive ? 1 : 0;
    left += point.outcome == Outcome::kFalseNegative ? 1 : 0;
    const Eigen::Vector3d at = raw.camera().to_view(point.world);
    within += raw.camera().window.contains(at) ? 1 : 0;
    const Colour still = static_colour(point.above_sensor);
    raw.add(at, moves ? verdict_colours::kFalseNegative : still, moves ? 2 : 1);
    if (!gone) cleaned.add(at, moves ? verdict_colours::kFalseNegative : still, moves ? 2 : 1);
    zoom.add(at, point.outcome == Outcome::kKeptStatic ? still : outcome_colour(point.outcome), 2);
  }
};

/// Draws the outline of the place that is shown at a larger scale.
void draw_outline(Canvas& canvas, const ObliqueCamera& camera, const WorldWindow& place, int left,
                  int top) {
  const auto line = [&](double x0, double y0, double x1, double y1) {
    constexpr int kSteps = 600;
    for (int i = 0; i <= kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      const auto at = camera.place({x0 + share * (x1 - x0), y0 + share * (y1 - y0), camera.ground});
      if (at.x < 0 || at.y < 0 || at.x + 1 > camera.width() || at.y + 1 > camera.height()) continue;
      canvas.fill(left + static_cast<int>(at.x), top + static_cast<int>(at.y), 2, 2, kInk);
    }
  };
  line(place.x_min, place.y_min, place.x_max, place.y_min);
  line(place.x_max, place.y_min, place.x_max, place.y_max);
  line(place.x_max, place.y_max, place.x_min, place.y_max);
  line(place.x_min, place.y_max, place.x_min, place.y_min);
}

std::string percent_text(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "none";
  return percent_text(static_cast<double>(part) / static_cast<double>(whole), 2);
}

Canvas drawn(const KeptCell& cell, std::size_t scans, const Views& views,
             const WorldWindow& place) {
  const int wide = views.raw.camera().width(), high = views.raw.camera().height();
  const int zoom_wide = views.zoom.camera().width(), zoom_high = views.zoom.camera().height();
  const int maps_high = 2 * (kOverviewHeading + high) + kOverviewGap;
  const int body = std::max(maps_high, kOverviewHeading + zoom_high);
  Canvas canvas(2 * kOverviewMargin + wide + kOverviewGap + zoom_wide,
                2 * kOverviewMargin + body + 30);
  const auto panel = [&](const ObliqueRaster& raster, int x, int y, const std::string& heading) {
    const int size = canvas.text_width(heading, 14) <= raster.camera().width() ? 14 : 12;
    canvas.text(x, y + 18, canvas.fitted(heading, size, raster.camera().width()), size, kInk);
    raster.draw(canvas, x, y + kOverviewHeading);
    canvas.frame(x, y + kOverviewHeading, raster.camera().width(), raster.camera().height(),
                 kBorder);
  };
  panel(views.raw, kOverviewMargin, kOverviewMargin,
        cell.sequence + ": all points of " + grouped_text(scans) + " scans, " +
            percent_text(views.moving, views.points) + " of them moving");
  const int second = kOverviewMargin + kOverviewHeading + high + kOverviewGap;
  panel(views.cleaned, kOverviewMargin, second,
        "Cleaned by " + cell.name + ": " + percent_text(views.left, views.moving) +
            " of moving points left, " + percent_text(views.wrong, views.points - views.moving) +
            " of static ones lost");
  const int right = kOverviewMargin + wide + kOverviewGap;
  panel(views.zoom, right, kOverviewMargin, "Removed points within the outline");
  draw_outline(canvas, views.raw.camera(), place, kOverviewMargin,
               kOverviewMargin + kOverviewHeading);
  draw_outline(canvas, views.raw.camera(), place, kOverviewMargin, second + kOverviewHeading);
  draw_scale_bar(canvas, kOverviewMargin + 10, second + kOverviewHeading + high - 12,
                 views.raw.camera().resolution, wide / 5);
  draw_outcome_legend(canvas, kOverviewMargin, kOverviewMargin + body + 24, 13);
  return canvas;
}

}  // namespace

Canvas overview_picture(const KeptRun& run, const KeptCell& cell, const OverviewOptions& options,
                        const OpenContext& context) {
  if (!cell.has_removals())
    (void)run.masks(cell, {});  // Throws the reason before anything is read.
  const Sequence sequence = run.open(cell.sequence, context);
  const std::vector<MaskStore> masks = {run.masks(cell, sequence)};
  const LocalFrameSource scans(*sequence.scans, sequence.upright_frame());
  const ObliqueCamera camera = camera_of(scans, options);
  ObliqueCamera close = camera;
  close.window = busiest_place(sequence, scans, masks, camera, context);
  // As high as the two maps together.
  close.resolution = camera.resolution * close.height() /
                     (2.0 * camera.height() + kOverviewHeading + kOverviewGap);
  Views views{ObliqueRaster(camera), ObliqueRaster(camera), ObliqueRaster(close)};
  for_each_point(sequence, scans, masks, "drawing", context,
                 [&](const PointOutcome& point) { views.add(point); });
  if (options.crop && views.within == 0) {
    throw_empty_crop(*options.crop, window_around_way(scans));
  }
  return drawn(cell, sequence.scans->size(), views, close.window);
}

}  // namespace raymoval
