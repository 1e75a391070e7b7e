// SPDX-License-Identifier: MIT
// Compiled without errno and trap handling of the square root (see CMakeLists.txt), so that
// the loop of `ImageFrame::project` is vectorised.
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/parallel.h"
#include "methods/common/single_angles.h"
#include "methods/mapcleaner/votes.h"

namespace raymoval::mapcleaner_method {
namespace {

/// Work for a thread at a time; no effect on the result.
constexpr std::size_t kImagePointsATask = 16 * ImageFrame::Batch::kSize;

/// The number of pixels in an angle.
int pixels_in(double angle, double pixel) {
  constexpr double kRounding = 1e-6;
  return std::max(1, static_cast<int>(std::ceil(angle / pixel - kRounding)));
}

/// Whether a step between beams is a whole window of rows, or more. Then beams must be in the
/// middle of rows: on a border, some of their points would fall in the next window.
bool is_one_beam_a_window(const Parameters& parameters, const SensorModel& sensor) {
  constexpr double kRounding = 1e-9;
  const double window = (2 * parameters.window_rows + 1) * parameters.row_height * kDegree;
  return !parameters.public_steps && sensor.elevation_step > window - kRounding;
}

}  // namespace

ImageFrame::ImageFrame(const Parameters& parameters, const SensorModel& sensor)
    : row_height(parameters.row_height * kDegree), column_width(parameters.column_width * kDegree) {
  double width = kTurn, height = parameters.vertical_view * kDegree;
  azimuth_from = -kTurn / 2.0;
  elevation_from = -height / 2.0;
  if (!parameters.public_field_of_view) {
    is_circle = sensor.full_circle();
    // One more pixel on each side, because the outermost beams spread.
    const double margin = row_height * (is_one_beam_a_window(parameters, sensor) ? 1.5 : 1.0);
    elevation_from = sensor.elevation_min - margin;
    height = sensor.elevation_max + margin - elevation_from;
    if (!is_circle) {
      azimuth_from = sensor.azimuth_min - column_width;
      width = sensor.azimuth_max + column_width - azimuth_from;
    }
  }
  rows = pixels_in(height, row_height);
  columns = pixels_in(width, column_width);
}

void ImageFrame::project(Batch& batch, int count) const {
  const auto row_scale = static_cast<float>(1.0 / row_height);
  const auto column_scale = static_cast<float>(1.0 / column_width);
  const auto lowest = static_cast<float>(elevation_from), first = static_cast<float>(azimuth_from);
  constexpr auto kCircle = static_cast<float>(kTurn);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const float x = batch.x[i], y = batch.y[i], z = batch.z[i];
    const float flat_square = x * x + y * y;
    const float from_first = single_azimuth(x, y) - first;
    const float raised = from_first < 0.0F ? from_first + kCircle : from_first;
    const float turned = raised >= kCircle ? raised - kCircle : raised;
    batch.column[i] = turned * column_scale;
    batch.row[i] = (single_elevation(std::sqrt(flat_square), z) - lowest) * row_scale;
    batch.range[i] = std::sqrt(flat_square + z * z);
  }
}

RangeImage::RangeImage(const Parameters& parameters, const SensorModel& sensor)
    : frame_(parameters, sensor),
      keeps_last_(parameters.public_overwrite),
      wide_(parameters.window_columns),
      high_(parameters.window_rows),
      tolerance_(static_cast<float>(parameters.tolerance)) {
  ranges_.resize(static_cast<std::size_t>(frame_.rows) * static_cast<std::size_t>(frame_.columns));
}

void RangeImage::fill(const Scan& scan, int threads) {
  pixels_.resize(scan.size());
  point_ranges_.resize(scan.size());
  parallel_chunks(threads, scan.size(), kImagePointsATask, [&](std::size_t from, std::size_t to) {
    ImageFrame::Batch batch;
    for (std::size_t begin = from; begin < to; begin += ImageFrame::Batch::kSize) {
      const std::size_t count = std::min<std::size_t>(ImageFrame::Batch::kSize, to - begin);
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3f& point = scan.points[begin + i];
        batch.x[i] = point.x();
        batch.y[i] = point.y();
        batch.z[i] = point.z();
      }
      frame_.project(batch, static_cast<int>(count));
      for (std::size_t i = 0; i < count; ++i) {
        pixels_[begin + i] = frame_.pixel_of(batch, static_cast<int>(i));
        point_ranges_[begin + i] = batch.range[i];
      }
    }
  });
  std::fill(ranges_.begin(), ranges_.end(), 0.0F);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    if (pixels_[i] < 0) continue;
    float& seen = ranges_[static_cast<std::size_t>(pixels_[i])];
    if (keeps_last_ || seen == 0.0F || point_ranges_[i] < seen) seen = point_ranges_[i];
  }
}

Sight RangeImage::look(int pixel, float range) const {
  const int columns = frame_.columns;
  const int row = pixel / columns, column = pixel % columns;
  const int wide = std::min(wide_, (columns - 1) / 2);  // No pixel is in a window twice.
  Sight sight = Sight::kNothing;
  bool is_hidden = false;
  for (int y = std::max(0, row - high_); y <= std::min(frame_.rows - 1, row + high_); ++y) {
    for (int step = -wide; step <= wide; ++step) {
      int x = column + step;
      if (frame_.is_circle) x = x < 0 ? x + columns : x < columns ? x : x - columns;
      if (x < 0 || x >= columns) continue;
      const float seen = at(y, x), difference = seen - range;
      if (seen == 0.0F) continue;
      if (difference <= tolerance_ && difference >= -tolerance_) return Sight::kSeen;
      is_hidden |= difference < 0.0F;
      sight = Sight::kSeenThrough;
    }
  }
  return is_hidden ? Sight::kNothing : sight;
}

}  // namespace raymoval::mapcleaner_method
