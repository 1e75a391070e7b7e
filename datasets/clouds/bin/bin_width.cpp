// SPDX-License-Identifier: MIT
#include "datasets/clouds/bin/bin_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr std::size_t kUsualWidth = 4;
constexpr std::array<std::size_t, 4> kOtherWidths = {3, 5, 6, 7};
/// Numbers in a row of the file, which begin with a point under any of these widths.
constexpr std::size_t kBlock = 1260;
constexpr std::size_t kFewestBlocks = 2, kMostBlocks = 8, kMostScans = 5;
/// Distance up to which columns are alike, and from which on they differ. Simulated scans of all
/// sensors have at least 0.5 under their own width (0.14 where most points are no returns, at
/// (0, 0, 0)) and at most 0.07 under another one.
constexpr double kAlike = 0.1, kDifferent = 0.3;

/// Some blocks of the numbers of a file, evenly spread. Empty for a small file.
std::vector<float> sampled_numbers(const std::filesystem::path& path) {
  constexpr std::size_t kBytes = kBlock * sizeof(float);
  const auto blocks = static_cast<std::size_t>(plain_file_size(path) / kBytes);
  if (blocks < kFewestBlocks) return {};
  std::string bytes;
  for (const std::size_t block : evenly_spread(blocks, kMostBlocks)) {
    bytes += read_piece(path, block * kBytes, kBytes);
  }
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  for (float& number : numbers) {
    if (!std::isfinite(number)) number = std::numeric_limits<float>::max();
  }
  return numbers;
}

/// The largest difference between the shares of both up to any value: 0 alike, 1 apart.
/// @param a, b in order
double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0.0;
  std::size_t in_a = 0, in_b = 0;
  while (in_a < a.size() && in_b < b.size()) {
    const float value = std::min(a[in_a], b[in_b]);
    while (in_a < a.size() && a[in_a] == value) ++in_a;
    while (in_b < b.size() && b[in_b] == value) ++in_b;
    most = std::max(most, std::abs(static_cast<double>(in_a) / static_cast<double>(a.size()) -
                                   static_cast<double>(in_b) / static_cast<double>(b.size())));
  }
  return most;
}

/// The largest distance between columns that a mixture of two widths would make alike: those whose
/// numbers differ by a multiple of `step`, the common divisor of the widths.
double column_distance(const std::vector<float>& numbers, std::size_t width, std::size_t step) {
  std::vector<std::vector<float>> columns(width);
  for (std::size_t i = 0; i < numbers.size(); ++i) columns[i % width].push_back(numbers[i]);
  for (std::vector<float>& column : columns) std::sort(column.begin(), column.end());
  double most = 0.0;
  for (std::size_t a = 0; a < width; ++a) {
    for (std::size_t b = a + step; b < width; b += step) {
      most = std::max(most, distance(columns[a], columns[b]));
    }
  }
  return most;
}

/// How much the columns differ under `width`; 0 if they differ under the usual width as well.
double told_apart(const std::vector<float>& numbers, std::size_t width) {
  const std::size_t step = std::gcd(width, kUsualWidth);
  if (column_distance(numbers, kUsualWidth, step) > kAlike) return 0.0;
  return column_distance(numbers, width, step);
}

/// Those of the other widths that the sizes of all scans fit.
std::vector<std::size_t> fitting_widths(const std::vector<std::filesystem::path>& scans) {
  std::vector<std::size_t> widths(kOtherWidths.begin(), kOtherWidths.end());
  for (const std::filesystem::path& scan : scans) {
    if (widths.empty()) break;
    const std::uintmax_t bytes = plain_file_size(scan);
    std::erase_if(widths, [&](std::size_t width) { return bytes % (width * sizeof(float)) != 0; });
  }
  return widths;
}

/// The one of `widths` under which the columns of each scan differ most, if they do.
std::optional<std::size_t> seen_width(const std::vector<std::filesystem::path>& scans,
                                      const std::vector<std::size_t>& widths) {
  constexpr double kClearly = 0.05;  // Of two widths that do as well, the smaller is the width.
  std::vector<double> least(widths.size(), 1.0);
  bool any = false;
  for (const std::size_t at : evenly_spread(scans.size(), kMostScans)) {
    const std::vector<float> numbers = sampled_numbers(scans[at]);
    if (numbers.empty()) continue;
    any = true;
    for (std::size_t k = 0; k < widths.size(); ++k) {
      least[k] = std::min(least[k], told_apart(numbers, widths[k]));
    }
  }
  std::optional<std::size_t> seen;
  double best = kDifferent - kClearly;
  for (std::size_t k = 0; any && k < widths.size(); ++k) {
    if (least[k] < best + kClearly) continue;
    best = least[k];
    seen = widths[k];
  }
  return seen;
}

}  // namespace

void check_bin_width(const std::vector<std::filesystem::path>& scans,
                     const RecordReading& reading) {
  if (reading.point_layout) return;
  std::vector<std::filesystem::path> bins;
  std::copy_if(scans.begin(), scans.end(), std::back_inserter(bins),
               [](const std::filesystem::path& scan) { return scan.extension() == ".bin"; });
  if (bins.empty()) return;
  const std::vector<std::size_t> widths = fitting_widths(bins);
  if (widths.empty()) return;
  const auto width = seen_width(bins, widths);
  if (!width) return;
  std::string layout = "x y z";
  if (*width > kUsualWidth) layout += " intensity";
  for (std::size_t k = kUsualWidth; k < *width; ++k) layout += " _";
  throw DataError(bins.front().string() + ": its points look like " + std::to_string(*width) +
                  " float32 numbers each (" + std::to_string(*width * sizeof(float)) +
                  " bytes); expected 4 (x y z reflectance, 16 bytes), under which coordinates and "
                  "other fields would be mixed. Name the fields of a point: --point-layout \"" +
                  layout +
                  "\", with names instead of _ for what is worth keeping. If there are 4 "
                  "all the same, say --point-layout \"x y z intensity\".");
}

}  // namespace raymoval
