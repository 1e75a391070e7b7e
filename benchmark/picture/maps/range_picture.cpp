// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/range_picture.h"

#include <algorithm>
#include <cmath>

#include "benchmark/picture/canvas/canvas.h"
#include "benchmark/picture/canvas/colour_maps.h"
#include "benchmark/picture/maps/point_outcome.h"
#include "benchmark/picture/maps/top_down.h"
#include "core/error.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval {
namespace {

using namespace raymoval_method;

constexpr int kRangeMargin = 20;
constexpr int kRangeHeading = 28;
constexpr int kRangeGap = 12;
constexpr double kVoxel = 0.2;
constexpr double kMostRange = 60.0;  ///< Of the colours, metres.
constexpr double kMostDifference = 10.0;

/// The scan to be shown. @throws UsageError naming what there is
std::size_t scan_index(const Sequence& sequence, const std::optional<long>& frame) {
  const std::size_t count = sequence.scans->size();
  if (count == 0) throw DataError("sequence '" + sequence.name + "' has no scan.");
  if (!frame) return count / 2;
  const FrameRange range = parse_frame_range(sequence.frames);
  const long offset = *frame - range.first.value_or(0);
  const long index = offset / std::max(1L, range.stride);
  if (offset < 0 || offset % std::max(1L, range.stride) != 0 || index >= static_cast<long>(count)) {
    throw UsageError("--scan " + std::to_string(*frame) + ": sequence '" + sequence.name +
                     "' has no such frame in this run; its frames are " + sequence.frames +
                     " (first, last, stride).");
  }
  return static_cast<std::size_t>(index);
}

/// The elevations that the scan's points take up, in about as many rows as the sensor has beams.
AngularGrid grid_of(const Scan& scan, const SensorModel& sensor, int width) {
  AngularGrid grid;
  grid.azimuth_bins = width;
  double low = 1.6, high = -1.6;
  for (const auto& point : scan.points) {
    const double elevation = to_spherical(point.cast<double>()).elevation;
    low = std::min(low, elevation);
    high = std::max(high, elevation);
  }
  if (low > high) low = high = 0.0;
  const double step = sensor.elevation_step > 0.0 ? sensor.elevation_step : (high - low) / 64.0;
  // Beams are not evenly apart, so rows are a little higher than their mean distance.
  const double rows = step > 0.0 ? std::clamp((high - low) / (1.25 * step) + 1.0, 1.0, 256.0) : 1.0;
  grid.elevation_bins = static_cast<int>(rows);
  const double margin = std::max(1e-4, 0.5 * (high - low) / rows);
  grid.elevation_min = low - margin;
  grid.elevation_max = high + margin;
  return grid;
}

/// What the method left of all scans.
OccupancyMap cleaned_map(const Sequence& sequence, const ScanSource& scans, const MaskStore& masks,
                         const OpenContext& context) {
  OccupancyMap map(kVoxel);
  if (context.progress != nullptr) {
    context.progress->begin("the cleaned map of " + sequence.name, scans.size());
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (context.cancel != nullptr && context.cancel->load()) throw Cancelled();
    const Scan scan = scans.load(i);
    const Mask mask = masks.get(i);
    for (std::size_t k = 0; k < scan.size(); ++k) {
      if (mask[k] == 0 && scan.points[k].head<2>().norm() >= 1.0F) {
        map.insert(map.voxel_of(scan.T_world_sensor * scan.points[k].cast<double>()));
      }
    }
    if (context.progress != nullptr) context.progress->advance();
  }
  return map;
}

/// What is drawn: everything by bin of the grid.
struct RangeImages {
  AngularGrid grid;
  std::vector<float> scan, map;  ///< Metres; infinite where there is nothing.
  std::vector<int> outcome;      ///< Of the nearest point, -1 where there is none that is shown.
};

RangeImages images_of(const Sequence& sequence, const MaskStore& masks, std::size_t index,
                      int width, const OpenContext& context) {
  RangeImages images;
  const LocalFrameSource scans(*sequence.scans, lattice_frame(*sequence.scans));
  const Scan scan = scans.load(index);
  const std::vector<std::uint32_t> labels = sequence.labels->labels(scan);
  const Mask mask = masks.get(index);
  const ShownPoints points(sequence);
  images.grid = grid_of(scan, sequence.scans->sensor(), width);
  const auto bins = static_cast<std::size_t>(images.grid.size());
  images.scan.assign(bins, kNoRange);
  images.outcome.assign(bins, -1);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Spherical at = to_spherical(scan.points[k].cast<double>());
    const auto bin = images.grid.bin_of(at.azimuth, at.elevation);
    if (!bin || at.range < 0.5) continue;
    float& nearest = images.scan[static_cast<std::size_t>(*bin)];
    if (!(at.range < nearest)) continue;
    nearest = static_cast<float>(at.range);
    images.outcome[static_cast<std::size_t>(*bin)] =
        points.shows(scan.points[k], labels[k])
            ? static_cast<int>(outcome_of(points.moving(labels[k]), mask[k] != 0))
            : -1;
  }
  OccupancyMap map = cleaned_map(sequence, scans, masks, context);
  const RayLimits limits{1.0, std::min(120.0, sequence.scans->sensor().range_max)};
  images.map =
      cast_first_hits(map, scan.T_world_sensor, images.grid, limits, context.threads).range;
  return images;
}

Colour range_colour(float range) {
  if (!std::isfinite(range)) return kPaper;
  return sequential_colour(std::sqrt(range / kMostRange));
}

/// Map minus scan: positive where the scan stands in front of the map.
Colour difference_colour(float scan, float map) {
  if (!std::isfinite(scan)) return kPaper;
  if (!std::isfinite(map)) return {214, 214, 214};
  return diverging_colour((map - scan) / kMostDifference);
}

/// One of the images with its heading.
class Strip {
 public:
  Strip(Canvas& canvas, const RangeImages& images, int row_height, int top)
      : canvas_(canvas), images_(images), row_height_(row_height), top_(top) {}

  template <class ColourOf>
  void draw(const std::string& heading, ColourOf&& colour_of) {
    canvas_.text(kRangeMargin, top_ + 18, heading, 14, kInk);
    const AngularGrid& grid = images_.grid;
    const int height = grid.elevation_bins * row_height_;
    canvas_.draw_pixels(kRangeMargin, top_ + kRangeHeading, grid.azimuth_bins, height,
                        [&](int x, int y) {
                          const int row = grid.elevation_bins - 1 - y / row_height_;
                          const int bin = row * grid.azimuth_bins + grid.azimuth_bins - 1 - x;
                          return colour_of(static_cast<std::size_t>(bin));
                        });
    canvas_.frame(kRangeMargin, top_ + kRangeHeading, grid.azimuth_bins, height, kBorder);
  }

  /// Colours and what they mean at the right end of the heading.
  template <class ColourOf>
  void draw_scale(const std::string& low, const std::string& high, ColourOf&& colour_of) {
    constexpr int kLength = 160;
    const int right = kRangeMargin + images_.grid.azimuth_bins;
    const int end = right - canvas_.text_width(high, 12) - 8;
    canvas_.text(right, top_ + 18, high, 12, kSoftInk, Align::kRight);
    canvas_.draw_pixels(end - kLength, top_ + 8, kLength, 12,
                        [&](int x, int) { return colour_of((x + 0.5) / kLength); });
    canvas_.text(end - kLength - 6, top_ + 18, low, 12, kSoftInk, Align::kRight);
  }

 private:
  Canvas& canvas_;
  const RangeImages& images_;
  int row_height_, top_;
};

Canvas drawn(const std::string& title, const RangeImages& images) {
  const int rows = images.grid.elevation_bins;
  const int row_height =
      std::clamp(static_cast<int>(std::lround(images.grid.azimuth_bins / 7.0 / rows)), 1, 12);
  const int pitch = kRangeHeading + rows * row_height + kRangeGap;
  Canvas canvas(images.grid.azimuth_bins + 2 * kRangeMargin,
                kRangeMargin + 26 + 4 * pitch + kRangeMargin);
  canvas.text(kRangeMargin, kRangeMargin + 14, canvas.fitted(title, 17, images.grid.azimuth_bins),
              17, kInk);
  const auto strip = [&](int number) {
    return Strip(canvas, images, row_height, kRangeMargin + 26 + number * pitch);
  };
  const auto ranges = [](double share) { return sequential_colour(std::sqrt(share)); };
  strip(0).draw("Scan", [&](std::size_t bin) { return range_colour(images.scan[bin]); });
  strip(0).draw_scale("0", "60 m", ranges);
  strip(1).draw("First hit of the cleaned map",
                [&](std::size_t bin) { return range_colour(images.map[bin]); });
  strip(1).draw_scale("0", "60 m", ranges);
  strip(2).draw("Map minus scan (grey: nothing left in the map)", [&](std::size_t bin) {
    return difference_colour(images.scan[bin], images.map[bin]);
  });
  strip(2).draw_scale("-10", "10 m", [](double share) { return diverging_colour(2 * share - 1); });
  strip(3).draw("Verdict", [&](std::size_t bin) {
    return images.outcome[bin] < 0 ? kPaper : outcome_colour(Outcome(images.outcome[bin]));
  });
  draw_outcome_legend(canvas, kRangeMargin + 90, kRangeMargin + 26 + 3 * pitch + 18, 12);
  return canvas;
}

}  // namespace

Canvas range_picture(const KeptRun& run, const KeptCell& cell, const RangePictureOptions& options,
                     const OpenContext& context) {
  if (!cell.has_removals()) (void)run.masks(cell, {});  // Says why before anything is read.
  const Sequence sequence = run.open(cell.sequence, context);
  const std::size_t index = scan_index(sequence, options.frame);
  const MaskStore masks = run.masks(cell, sequence);
  const RangeImages images = images_of(sequence, masks, index, options.width, context);
  return drawn(cell.name + " on " + cell.sequence + ", scan " + sequence.scans->load(index).name,
               images);
}

}  // namespace raymoval
