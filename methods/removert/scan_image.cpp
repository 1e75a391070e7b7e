// SPDX-License-Identifier: MIT
#include "methods/removert/scan_image.h"

#include <bit>
#include <limits>

namespace raymoval::removert_method {
namespace {

/// Nearest range of the points in each pixel; -1 without a point.
std::vector<float> project_nearest(const std::vector<Eigen::Vector3f>& points,
                                   const PixelGrid& grid) {
  std::vector<float> nearest(static_cast<std::size_t>(grid.size()), -1.0F);
  PointBatch batch;
  for (std::size_t from = 0; from < points.size(); from += PointBatch::kSize) {
    const int count =
        static_cast<int>(std::min<std::size_t>(PointBatch::kSize, points.size() - from));
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3f& point = points[from + static_cast<std::size_t>(i)];
      batch.x[i] = point.x();
      batch.y[i] = point.y();
      batch.z[i] = point.z();
    }
    batch.project(grid, count);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d point = points[from + static_cast<std::size_t>(i)].cast<double>();
      int pixel = grid.fast_pixel(batch.row[i], batch.column[i]);
      if (pixel == kAmbiguous) pixel = grid.pixel_of(point);
      if (pixel == kOutside) continue;
      const auto range = static_cast<float>(point.norm());
      float& value = nearest[static_cast<std::size_t>(pixel)];
      if (value < 0.0F || range < value) value = range;
    }
  }
  return nearest;
}

std::vector<float> limits_of(const std::vector<float>& nearest, const Parameters& parameters,
                             Candidates candidates) {
  std::vector<float> limit(nearest.size(), -1.0F);
  for (std::size_t u = 0; u < nearest.size(); ++u) {
    if (nearest[u] < 0.0F) continue;
    limit[u] = candidates == Candidates::kAll ? std::numeric_limits<float>::infinity()
                                              : nearest[u] - threshold(nearest[u], parameters);
  }
  return limit;
}

}  // namespace

MaximumPyramid::MaximumPyramid(const std::vector<float>& image, int rows, int columns) {
  levels_.push_back({rows, columns, image});
  while (levels_.back().rows > 1 || levels_.back().columns > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
    coarse.values.assign(static_cast<std::size_t>(coarse.rows * coarse.columns), -1.0F);
    for (int row = 0; row < fine.rows; ++row) {
      const float* from = &fine.values[static_cast<std::size_t>(row * fine.columns)];
      float* to = &coarse.values[static_cast<std::size_t>(row / 2 * coarse.columns)];
      for (int column = 0; column < fine.columns; ++column) {
        to[column / 2] = std::max(to[column / 2], from[column]);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

float MaximumPyramid::bound(int row_from, int row_to, int column_from, int column_to) const {
  // On the level chosen a rectangle touches at most 5 x 5 values.
  const auto span = static_cast<unsigned>(std::max(row_to - row_from, column_to - column_from));
  const std::size_t coarseness =
      std::min<std::size_t>(std::bit_width(span >> 2), levels_.size() - 1);
  const Level& level = levels_[coarseness];
  float largest = -1.0F;
  for (int row = row_from >> coarseness; row <= row_to >> coarseness; ++row) {
    const float* values = &level.values[static_cast<std::size_t>(row * level.columns)];
    for (int column = column_from >> coarseness; column <= column_to >> coarseness; ++column) {
      largest = std::max(largest, values[column]);
    }
  }
  return largest;
}

float threshold(float range, const Parameters& parameters) {
  return static_cast<float>(parameters.gamma) * range;
}

ScanImage::ScanImage(const std::vector<Eigen::Vector3f>& points, const PixelGrid& pixel_grid,
                     const Parameters& parameters, Candidates candidates)
    : grid(pixel_grid),
      nearest(project_nearest(points, grid)),
      limit(limits_of(nearest, parameters, candidates)),
      limit_pyramid(limit, grid.rows(), grid.columns()) {}

}  // namespace raymoval::removert_method
