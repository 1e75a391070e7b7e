// SPDX-License-Identifier: MIT
// Compiled without errno and trap handling of the square root (see CMakeLists.txt), so that
// the loop of `ImageFrame::project` is vectorised.
#include "methods/mapcleaner/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/parallel.h"
#include "methods/common/single_angles.h"

namespace raymoval::mapcleaner_method {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
/// Work for a thread at a time. They change no answer.
constexpr std::size_t kImagePointsATask = 16 * ImageFrame::Batch::kSize, kRowsATask = 4;

/// How many pixels an angle has room for.
int pixels_in(double angle, double pixel) {
  constexpr double kRounding = 1e-6;
  return std::max(1, static_cast<int>(std::ceil(angle / pixel - kRounding)));
}

/// Replaces `lowest` and `highest` by the extremes of those up to `reach` steps away in both
/// directions, where `at(i)` says where the values i = -reach to reach begin.
template <class At>
void take_extremes(int count, int reach, At&& at, float* lowest, float* highest) {
  std::fill_n(lowest, count, kInfinite);
  std::fill_n(highest, count, 0.0F);
  for (int step = -reach; step <= reach; ++step) {
    const auto [low, high] = at(step);
    if (low == nullptr) continue;
    for (int i = 0; i < count; ++i) {
      lowest[i] = low[i] < lowest[i] ? low[i] : lowest[i];
      highest[i] = high[i] > highest[i] ? high[i] : highest[i];
    }
  }
}

/// Whether a step between beams is a whole window of rows, or more. Then beams have to lie in the
/// middle of rows: on the border of two, some of their points would fall in the next window.
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
    // A pixel more on each side: the outermost beams spread.
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
  const std::size_t size =
      static_cast<std::size_t>(frame_.rows) * static_cast<std::size_t>(frame_.columns);
  ranges_.resize(size);
  lowest_.resize(size);
  highest_.resize(size);
  row_lowest_.resize(size);
  row_highest_.resize(size);
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
  find_extremes(threads);
}

void RangeImage::find_extremes(int threads) {
  const int columns = frame_.columns, rows = frame_.rows;
  const int wide = std::min(wide_, (columns - 1) / 2);  // No pixel stands in a window twice.
  parallel_for(threads, static_cast<std::size_t>(rows), kRowsATask, [&](std::size_t row) {
    // The row with what is beside its ends.
    const auto padded = static_cast<std::size_t>(columns + 2 * wide);
    std::vector<float> low(padded, kInfinite), high(padded, 0.0F);
    for (int i = 0; i < columns + 2 * wide; ++i) {
      int column = i - wide;
      if (frame_.is_circle) column = (column + columns) % columns;
      if (column < 0 || column >= columns) continue;
      const float range = at(static_cast<int>(row), column);
      if (range == 0.0F) continue;
      low[static_cast<std::size_t>(i)] = high[static_cast<std::size_t>(i)] = range;
    }
    const std::size_t begin = index(static_cast<int>(row), 0);
    take_extremes(
        columns, wide,
        [&](int step) { return std::pair(low.data() + wide + step, high.data() + wide + step); },
        row_lowest_.data() + begin, row_highest_.data() + begin);
  });
  parallel_for(threads, static_cast<std::size_t>(rows), kRowsATask, [&](std::size_t row) {
    const auto beside = [&](int step) {
      const int other = static_cast<int>(row) + step;
      using Pointers = std::pair<const float*, const float*>;
      if (other < 0 || other >= rows) return Pointers(nullptr, nullptr);
      return Pointers(row_lowest_.data() + index(other, 0), row_highest_.data() + index(other, 0));
    };
    const std::size_t begin = index(static_cast<int>(row), 0);
    take_extremes(columns, high_, beside, lowest_.data() + begin, highest_.data() + begin);
  });
}

bool RangeImage::has_equal(int pixel, float range) const {
  const int columns = frame_.columns;
  const int row = pixel / columns, column = pixel % columns;
  const int wide = std::min(wide_, (columns - 1) / 2);
  for (int y = std::max(0, row - high_); y <= std::min(frame_.rows - 1, row + high_); ++y) {
    for (int step = -wide; step <= wide; ++step) {
      int x = column + step;
      if (frame_.is_circle) x = (x + columns) % columns;
      if (x < 0 || x >= columns) continue;
      const float seen = at(y, x);
      if (seen > 0.0F && is_equal(seen, range)) return true;
    }
  }
  return false;
}

}  // namespace raymoval::mapcleaner_method
