// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/angular_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/parallel.h"
#include "methods/raymoval/kernels/scan_kernels.h"

namespace raymoval::raymoval_method {

using std::numbers::pi;

Spherical to_spherical(const Eigen::Vector3d& point) {
  const double range = point.norm();
  if (range == 0.0) return {0.0, 0.0, 0.0};
  return {range, std::atan2(point.y(), point.x()),
          std::asin(std::clamp(point.z() / range, -1.0, 1.0))};
}

double AngularGrid::azimuth_step() const {
  return 2.0 * pi / azimuth_bins;
}

double AngularGrid::elevation_step() const {
  return (elevation_max - elevation_min) / elevation_bins;
}

std::optional<int> AngularGrid::bin_of(double azimuth, double elevation) const {
  const double j = std::floor((elevation - elevation_min) / elevation_step());
  if (!(j >= 0.0 && j < elevation_bins)) return std::nullopt;
  // The azimuth pi is the azimuth -pi.
  const int i = static_cast<int>(std::floor((azimuth + pi) / azimuth_step()));
  return static_cast<int>(j) * azimuth_bins + (i >= azimuth_bins ? 0 : std::max(i, 0));
}

double AngularGrid::azimuth_centre(int i) const {
  return -pi + (i + 0.5) * azimuth_step();
}

double AngularGrid::elevation_centre(int j) const {
  return elevation_min + (j + 0.5) * elevation_step();
}

Eigen::Vector3d AngularGrid::direction(int bin) const {
  const double azimuth = azimuth_centre(azimuth_of(bin));
  const double elevation = elevation_centre(elevation_of(bin));
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

namespace {

constexpr std::size_t kPointGrain = 8192;

/// Eqs 1-3 for one point, exactly by the formulas.
std::int32_t bin_of_point(const Eigen::Vector3f& point, const AngularGrid& grid,
                          double minimum_range) {
  const Spherical at = to_spherical(point.cast<double>());
  if (at.range < minimum_range) return kernels::kNoBin;
  return grid.bin_of(at.azimuth, at.elevation).value_or(kernels::kNoBin);
}

}  // namespace

void project(const Scan& scan, const AngularGrid& grid, double minimum_range, int threads,
             ProjectedScan& projected) {
  const kernels::ScanKernels kernel = kernels::best_scan_kernels();
  projected.range.resize(scan.size());
  projected.bin.resize(scan.size());
  kernels::Projection job;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  job.points = scan.points.empty() ? nullptr : scan.points.front().data();
  job.minimum_range = minimum_range;
  job.elevation_min = grid.elevation_min;
  job.azimuth_bins_per_radian = 1.0 / grid.azimuth_step();
  job.elevation_bins_per_radian = 1.0 / grid.elevation_step();
  job.azimuth_bins = grid.azimuth_bins;
  job.elevation_bins = grid.elevation_bins;
  job.range = projected.range.data();
  job.bin = projected.bin.data();
  const auto single = [&](std::size_t k) {
    job.range[k] = static_cast<float>(scan.points[k].cast<double>().norm());
    job.bin[k] = bin_of_point(scan.points[k], grid, minimum_range);
  };
  parallel_chunks(threads, scan.size(), kPointGrain, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kPiece = 64;  // Few of them have a close call.
    const std::size_t middle = begin + (end - begin) / kernel.lanes * kernel.lanes;
    for (std::size_t from = begin; from < middle; from += kPiece) {
      const std::size_t to = std::min(from + kPiece, middle);
      if (!kernel.project(job, from, to)) continue;
      for (std::size_t k = from; k < to; ++k) {
        if (job.bin[k] == kernels::kCloseCall) single(k);
      }
    }
    for (std::size_t k = middle; k < end; ++k) single(k);
  });
  projected.minimum_range.assign(static_cast<std::size_t>(grid.size()), kNoRange);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    if (job.bin[k] < 0) continue;
    float& nearest = projected.minimum_range[static_cast<std::size_t>(job.bin[k])];
    nearest = std::min(nearest, job.range[k]);
  }
}

namespace {

/// Sets the neighbours of all set bits.
void widen(std::span<std::uint64_t> words) {
  std::uint64_t before = 0;  // The original previous word.
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::uint64_t here = words[w];
    const std::uint64_t after = w + 1 < words.size() ? words[w + 1] : 0;
    words[w] |= here << 1 | before >> 63 | here >> 1 | after << 63;
    before = here;
  }
}

/// Clears the bits from `rows` on; there is at least one.
void cut(std::span<std::uint64_t> words, std::size_t rows) {
  words.back() &= ~(~std::uint64_t{0} << rows % 64);
}

}  // namespace

void WantedBins::request_all(const AngularGrid& grid) {
  request_around(std::vector<float>(static_cast<std::size_t>(grid.size())), grid, 0);
}

void WantedBins::request_around(const std::vector<float>& values, const AngularGrid& grid,
                                int radius) {
  const auto columns = static_cast<std::size_t>(grid.azimuth_bins);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  words_ = rows / 64 + 1;
  finite_.assign(columns * words_, 0);
  for (std::size_t j = 0; j < rows; ++j) {
    const std::uint64_t bit = std::uint64_t{1} << j % 64;
    const float* row = values.data() + j * columns;
    for (std::size_t i = 0; i < columns; ++i) {
      if (row[i] != kNoRange) finite_[i * words_ + j / 64] |= bit;
    }
  }
  for (std::size_t i = 0; i < columns; ++i) {
    const std::span<std::uint64_t> column(&finite_[i * words_], words_);
    for (int step = 0; step < radius; ++step) widen(column);
    cut(column, rows);
  }
  columns_ = finite_;
  for (int i = 0; i < grid.azimuth_bins; ++i) {
    std::uint64_t* column = &columns_[static_cast<std::size_t>(i) * words_];
    for (int offset = -radius; offset <= radius; ++offset) {
      const int beside = (i + offset + radius * grid.azimuth_bins) % grid.azimuth_bins;
      const std::uint64_t* other = &finite_[static_cast<std::size_t>(beside) * words_];
      for (std::size_t w = 0; w < words_; ++w) column[w] |= other[w];
    }
  }
}

}  // namespace raymoval::raymoval_method
