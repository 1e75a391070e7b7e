// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/format/stored_points.h"

namespace raymoval {
namespace {

/// " Rows of 20 bytes (5 float32 numbers) or ... would fit", for usual sizes.
std::string fitting_sizes(std::uintmax_t bytes) {
  std::vector<std::string> sizes;
  for (std::uintmax_t floats = 3; floats <= 8 && bytes > 0; ++floats) {
    if (bytes % (4 * floats) != 0) continue;
    sizes.push_back(std::to_string(4 * floats) + " (" + std::to_string(floats) + " float32)");
  }
  if (sizes.empty()) return "";
  return " It fits points of " + join(sizes, " or ") +
         " bytes: if its points are such, name their fields with --point-layout.";
}

/// The Kolmogorov-Smirnov distance: 0 for equal distributions, 1 for disjoint ones.
/// @param a, b sorted
double distance(const std::vector<float>& a, const std::vector<float>& b);
double column_distance(const std::vector<float>& numbers, std::size_t width, std::size_t step);

/// The share of numbers that are neither 0 nor of the size of coordinates or intensities.
template <class Number>
double odd_share(const std::string& bytes) {
  std::size_t odd = 0;
  const std::size_t count = bytes.size() / sizeof(Number);
  for (std::size_t i = 0; i < count; ++i) {
    Number number;
    std::memcpy(&number, bytes.data() + i * sizeof number, sizeof number);
    const double size = std::abs(static_cast<double>(number));
    odd += !(size == 0.0 || (size > 1e-7 && size < 1e7)) ? 1 : 0;
  }
  return static_cast<double>(odd) / static_cast<double>(count);
}

/// The point layout of a file whose numbers are implausible as float32 and plausible as float64;
/// else empty. Read as float32, half of the words of float64 numbers have a random exponent.
std::string double_layout(const std::filesystem::path& path) {
  constexpr std::size_t kFewest = 30, kMost = 2520;  // A multiple of all widths.
  const std::string bytes = read_piece(path, 0, kMost * sizeof(double));
  const std::size_t count = bytes.size() / sizeof(double);
  if (count < kFewest || odd_share<float>(bytes) < 0.1 || odd_share<double>(bytes) > 0.02)
    return "";
  std::vector<float> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    double number;
    std::memcpy(&number, bytes.data() + i * sizeof number, sizeof number);
    numbers.push_back(static_cast<float>(number));
  }
  std::size_t best = 0;
  double most = -1.0;
  for (const std::size_t width : {4, 3, 5, 6, 7, 8}) {
    if (plain_file_size(path) % (width * sizeof(double)) != 0) continue;
    const double apart = column_distance(numbers, width, 1);
    if (apart <= most + 0.05) continue;
    best = width;
    most = apart;
  }
  if (best == 0) return "";
  std::string layout = "x:f8 y:f8 z:f8";
  for (std::size_t k = 3; k < best; ++k) layout += k == 3 ? " intensity:f8" : " _:f8";
  return layout;
}

/// " Its numbers look like float64: ..."; empty if they do not.
std::string double_text(const std::filesystem::path& path) {
  const std::string layout = double_layout(path);
  if (layout.empty()) return "";
  return " Its numbers look like float64: use --point-layout \"" + layout + "\".";
}

/// @throws DataError naming the sizes of a point that would fit
void check_rows(const std::filesystem::path& path, std::uintmax_t bytes,
                const RecordLayout& layout) {
  const std::size_t row = layout.row_bytes;
  if (bytes % row == 0 && bytes / row <= kMostCloudPoints) return;
  const RecordLayout usual = bin_layout(std::nullopt);
  const std::string doubles = layout == usual && is_file(path) ? double_text(path) : "";
  throw DataError(path.string() + ": " + grouped_text(bytes) + " bytes is not a multiple of " +
                  std::to_string(row) + " (" +
                  (layout == usual ? "x y z reflectance as float32" : point_layout_text(layout)) +
                  "); the file looks truncated after point " + grouped_text(bytes / row) + "." +
                  kRereadRemedy + (doubles.empty() ? fitting_sizes(bytes) : doubles));
}

StoredPoints bin_points(const CloudBytes& file) {
  const RecordLayout layout = bin_layout(file.reading.point_layout);
  check_rows(file.path, file.text.size(), layout);
  StoredPoints stored{file.text, {}, file.text.size() / layout.row_bytes, layout.row_bytes};
  for (const PointField& field : layout.fields) {
    stored.columns.push_back({field, field.offset, layout.row_bytes, false});
  }
  return stored;
}

Cloud read_bin_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  return cloud_of(bin_points(file), origin, file.path.string());
}

PointRecords read_bin_records(const CloudBytes& file) {
  PointRecords records = records_of(bin_points(file));
  records.layout.unnamed = true;
  return records;
}

class BinEncoder : public RecordEncoder {
 public:
  void start(const PointRecords&) override {}
  std::string head(std::uint64_t) const override { return ""; }
};

std::vector<std::string> lost_in_bin(const RecordLayout& layout) {
  RecordLayout usual = bin_layout(std::nullopt);
  usual.unnamed = layout.unnamed;
  if (layout == usual) return {};
  return {
      "A .bin file does not hold the names and types of its fields: read it again with "
      "--point-layout \"" +
      point_layout_text(layout) + "\"."};
}

constexpr std::size_t kUsualWidth = 4;
constexpr std::array<std::size_t, 4> kOtherWidths = {3, 5, 6, 7};
/// Successive numbers of the file that are sampled together. A block begins with a point under any
/// of these widths.
constexpr std::size_t kBlock = 1260;
constexpr std::size_t kFewestBlocks = 2, kMostBlocks = 8, kMostScans = 5;
/// Distance up to which columns are alike, and from which on they differ. Simulated scans of all
/// sensors have at least 0.5 under the right width (0.14 if most points are missing returns at
/// (0, 0, 0)) and at most 0.07 under a wrong one.
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

/// The largest distance between columns that a wrong width would mix: columns whose numbers differ
/// by a multiple of `step`, the common divisor of both widths.
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

/// Distance of the columns under `width`; 0 if columns differ under the usual width as well.
double layout_difference(const std::vector<float>& numbers, std::size_t width) {
  const std::size_t step = std::gcd(width, kUsualWidth);
  if (column_distance(numbers, kUsualWidth, step) > kAlike) return 0.0;
  return column_distance(numbers, width, step);
}

/// The other widths that fit the sizes of all scans.
std::vector<std::size_t> fitting_widths(const std::vector<std::filesystem::path>& scans) {
  std::vector<std::size_t> widths(kOtherWidths.begin(), kOtherWidths.end());
  for (const std::filesystem::path& scan : scans) {
    if (widths.empty()) break;
    const std::uintmax_t bytes = plain_file_size(scan);
    std::erase_if(widths, [&](std::size_t width) { return bytes % (width * sizeof(float)) != 0; });
  }
  return widths;
}

/// The width of `widths` under which the columns of each scan differ most, if they do.
std::optional<std::size_t> seen_width(const std::vector<std::filesystem::path>& scans,
                                      const std::vector<std::size_t>& widths) {
  constexpr double kClearly = 0.05;  // A larger width must be better by this much.
  std::vector<double> least(widths.size(), 1.0);
  bool any = false;
  for (const std::size_t at : evenly_spread(scans.size(), kMostScans)) {
    const std::vector<float> numbers = sampled_numbers(scans[at]);
    if (numbers.empty()) continue;
    any = true;
    for (std::size_t k = 0; k < widths.size(); ++k) {
      least[k] = std::min(least[k], layout_difference(numbers, widths[k]));
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

void check_bin_size(const std::filesystem::path& path, std::uintmax_t bytes,
                    const RecordReading& reading) {
  check_rows(path, bytes, bin_layout(reading.point_layout));
}

void check_bin_width(const std::vector<std::filesystem::path>& scans,
                     const RecordReading& reading) {
  if (reading.point_layout) return;
  std::vector<std::filesystem::path> bins;
  std::copy_if(scans.begin(), scans.end(), std::back_inserter(bins),
               [](const std::filesystem::path& scan) { return scan.extension() == ".bin"; });
  if (bins.empty()) return;
  const std::filesystem::path& middle = bins[bins.size() / 2];
  if (const std::string doubles = double_text(middle); !doubles.empty()) {
    throw DataError(middle.string() +
                    ": as float32 its numbers would be no coordinates; expected 4 float32 numbers "
                    "a point (x y z reflectance)." +
                    doubles);
  }
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
                  "\", with names instead of _ for fields to keep. If there are 4 nevertheless, "
                  "use --point-layout \"x y z intensity\".");
}

CloudFormat bin_format() {
  CloudFormat format{".bin", read_bin_cloud, read_bin_records};
  format.encoder = [](const std::filesystem::path&) -> std::unique_ptr<RecordEncoder> {
    return std::make_unique<BinEncoder>();
  };
  format.lost = lost_in_bin;
  format.read_layout = [](const std::filesystem::path&, const RecordReading& reading) {
    return bin_layout(reading.point_layout);
  };
  return format;
}

}  // namespace raymoval
