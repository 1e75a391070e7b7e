// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/reading/left_out.h"

namespace raymoval::inspection {
namespace {

std::vector<Finding> look_for_millimetres(Samples& samples) {
  const double extent = samples.median_range();
  samples.measures.emplace_back("median_extent_m", extent);
  if (samples.point_scale() == 1.0) return {};
  Finding finding{
      .where = "points of all scans read",
      .what = fmt::format("half of the points lie more than {} from the middle of their scan; "
                          "taken as millimetres that is {} m",
                          fixed_text(extent, 0), fixed_text(0.001 * extent, 1))};
  // Hardly any sensor has half of its returns beyond this distance, metres; points in centimetres
  // do.
  constexpr double kFarthestUsual = 100.0;
  if (0.01 * extent < kFarthestUsual) {
    finding.what += ", as centimetres " + fixed_text(0.01 * extent, 1) + " m";
    finding.remedy =
        "Multiply the coordinates by 0.001 if they are millimetres, by 0.01 if they are "
        "centimetres.";
  }
  return {finding};
}

/// A note only: files of most drivers have such points, and readers leave them out.
std::vector<Finding> look_for_no_returns(Samples& samples) {
  const LeftOutPoints points = left_out_points(samples.sequence());
  std::vector<Finding> findings;
  for (const std::string& line : left_out_lines(samples.sequence())) {
    findings.push_back(
        {.severity = Severity::kNote, .where = "points of the scans read", .what = line});
  }
  if (points.no_returns > 0) {
    samples.measures.emplace_back("share_of_no_returns", static_cast<double>(points.no_returns) /
                                                             static_cast<double>(points.stored));
  }
  return findings;
}

/// Size of a scan: bytes of its file, else points.
struct ScanSize {
  std::size_t scan = 0;
  double size = 0.0;
};

std::vector<ScanSize> scan_sizes(const Samples& samples) {
  std::vector<ScanSize> sizes;
  for (std::size_t i = 0; i < samples.files().size(); ++i) {
    sizes.push_back({i, static_cast<double>(plain_file_size(samples.files()[i].path))});
  }
  if (!sizes.empty()) return sizes;
  for (const auto& [index, scan] : samples.scans()) {
    sizes.push_back({index, static_cast<double>(scan.stored_point_count)});
  }
  return sizes;
}

/// Middle size of up to three scans before and three after.
double size_around(const std::vector<ScanSize>& sizes, std::size_t at) {
  constexpr std::size_t kAround = 3;
  std::vector<double> around;
  const std::size_t first = at < kAround ? 0 : at - kAround;
  for (std::size_t i = first; i <= at + kAround && i < sizes.size(); ++i) {
    if (i != at) around.push_back(sizes[i].size);
  }
  return median(std::move(around));
}

/// Finds files that were truncated at a whole point. Such a file is readable, but is much smaller
/// than its neighbours, compared with their differences.
std::vector<Finding> look_for_few_points(Samples& samples) {
  constexpr double kLeastLoss = 0.2, kUsualLosses = 10.0, kMostLoss = 0.7;
  constexpr std::size_t kFewest = 4;
  const std::vector<ScanSize> sizes = scan_sizes(samples);
  if (sizes.size() < kFewest) return {};
  std::vector<double> shares, losses;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    shares.push_back(sizes[i].size / std::max(1.0, size_around(sizes, i)));
    losses.push_back(std::abs(1.0 - shares.back()));
  }
  const double loss = std::clamp(kUsualLosses * median(losses), kLeastLoss, kMostLoss);
  std::vector<std::size_t> small;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (shares[i] < 1.0 - loss) small.push_back(i);
  }
  if (small.empty()) return {};
  const std::size_t at = small.front();
  const std::string unit = samples.files().empty() ? " points" : " bytes";
  return {{.where = samples.scan_name(sizes[at].scan),
           .what = fmt::format(
               "holds {}{}, {} % of what the scans around it hold; it looks truncated{}",
               grouped_text(static_cast<std::uint64_t>(sizes[at].size)), unit,
               fixed_text(100.0 * shares[at], 0),
               small.size() > 1 ? ", and so do " + grouped_text(small.size() - 1) + " more" : "")}};
}

/// 16 KiB from the middle of a file: enough to distinguish scans.
std::string middle_piece(const std::filesystem::path& path, std::uintmax_t size) {
  constexpr std::uintmax_t kPiece = 16384;
  const std::uintmax_t piece = std::min(size, kPiece);
  return read_piece(path, (size - piece) / 2, static_cast<std::size_t>(piece));
}

/// Number of files that are compared byte by byte; of more copies, only the middles are compared.
constexpr std::size_t kCompared = 20;

/// Pairs of files with the same bytes; only those of equal size are opened.
std::vector<ScanPair> equal_files(const std::vector<FrameEntry>& files) {
  std::map<std::uintmax_t, std::vector<std::size_t>> by_size;
  for (std::size_t i = 0; i < files.size(); ++i) {
    by_size[plain_file_size(files[i].path)].push_back(i);
  }
  std::vector<ScanPair> pairs;
  for (const auto& [size, group] : by_size) {
    if (group.size() < 2) continue;
    std::map<std::string, std::size_t> seen;
    for (const std::size_t i : group) {
      const auto [first, is_new] = seen.emplace(content_hash(middle_piece(files[i].path, size)), i);
      if (is_new) continue;
      const bool sure = pairs.size() >= kCompared;
      if (sure || read_bytes(files[first->second].path) == read_bytes(files[i].path)) {
        pairs.push_back({first->second, i});
      }
    }
  }
  return pairs;
}

std::vector<ScanPair> equal_scans(const std::map<std::size_t, Scan>& scans) {
  std::vector<ScanPair> pairs;
  for (auto a = scans.begin(); a != scans.end(); ++a) {
    const auto b = std::next(a);
    if (b != scans.end() && a->second.points == b->second.points) {
      pairs.push_back({a->first, b->first});
    }
  }
  return pairs;
}

std::vector<Finding> look_for_duplicates(Samples& samples) {
  auto pairs =
      samples.files().empty() ? equal_scans(samples.scans()) : equal_files(samples.files());
  if (pairs.empty()) return {};
  std::sort(pairs.begin(), pairs.end(),
            [](const ScanPair& a, const ScanPair& b) { return a.to < b.to; });
  const std::string more =
      pairs.size() > 1 ? ", and there are " + grouped_text(pairs.size() - 1) + " more such pairs"
                       : "";
  return {{.where = samples.scan_name(pairs.front().to),
           .what = "is the same scan as " + samples.scan_name(pairs.front().from) + more}};
}

double share_between(const std::vector<double>& sorted, double from, double to) {
  const auto a = std::upper_bound(sorted.begin(), sorted.end(), from);
  const auto b = std::upper_bound(sorted.begin(), sorted.end(), to);
  return static_cast<double>(b - a) / static_cast<double>(sorted.size());
}

std::vector<double> sorted_ranges(const Scan& scan) {
  std::vector<double> ranges;
  ranges.reserve(scan.size());
  for (const Eigen::Vector3f& point : scan.points) {
    ranges.push_back(static_cast<double>(point.norm()));
  }
  std::sort(ranges.begin(), ranges.end());
  return ranges;
}

/// Finds a range filter: in every scan, the number of points drops to zero at the same range.
/// Without a filter, returns thin out gradually.
std::vector<Finding> look_for_truncation(Samples& samples) {
  constexpr double kEqual = 0.02, kBand = 0.05, kCliff = 0.5, kLeast = 0.002;
  constexpr double kShareOfSensor = 0.6, kUnknownSensor = 60.0;
  if (has_one_viewpoint(samples)) return {};  // Ranges are not those of the sensor.
  double nearest = 1e300, farthest = 0.0, last = 0.0, before = 0.0;
  for (const auto& [index, scan] : samples.scans()) {
    const std::vector<double> ranges = sorted_ranges(scan);
    const double end = ranges.back();
    nearest = std::min(nearest, end);
    farthest = std::max(farthest, end);
    last += share_between(ranges, end * (1.0 - kBand), end);
    before += share_between(ranges, end * (1.0 - 2.0 * kBand), end * (1.0 - kBand));
  }
  const auto count = static_cast<double>(samples.scans().size());
  samples.measures.emplace_back("farthest_point_m", farthest);
  samples.measures.emplace_back("share_of_points_in_last_5_percent", last / count);
  const SensorModel& sensor = samples.sequence().scans->sensor();
  const double usual = sensor.is_estimated() ? kUnknownSensor : kShareOfSensor * sensor.range_max;
  const bool cliff = last >= kCliff * before && last / count >= kLeast;
  if (samples.scans().size() < 2 || farthest > usual || !cliff) return {};
  if (farthest - nearest > kEqual * farthest) return {};
  const std::string sees =
      sensor.is_estimated()
          ? ""
          : fmt::format("; a {} sees up to {} m", sensor.name, fixed_text(sensor.range_max, 0));
  return {{.where = "points of all scans read",
           .what = fmt::format(
               "every scan ends at {} m with {} % of its points in the last 5 % of it{}",
               fixed_text(farthest, 1), fixed_text(100.0 * last / count, 1), sees)}};
}

}  // namespace

std::vector<Check> point_checks() {
  return {
      {"points-in-millimetres", "points are in millimetres", "metres",
       "Multiply the coordinates by 0.001.", look_for_millimetres, Consequence::kRefused},
      {"left-out",
       "points are missing returns (NaN or at the origin) or on the ego vehicle (--drop-ego), and "
       "no method gets them",
       "returns of the surroundings of the sensor",
       "Nothing to do: labels and masks still have a value for each stored point.",
       look_for_no_returns},
      {"few-points", "a scan has far fewer points than those around it",
       "as many points as in the scans before and after", "Copy the scan again with its labels.",
       look_for_few_points},
      {"duplicated-scans", "a scan occurs twice", "each scan once",
       "Remove the copy with its pose and labels.", look_for_duplicates},
      {"range-truncated", "points beyond a range are missing", "all returns of the sensor",
       "Use unfiltered scans; --range MIN:MAX limits the evaluation and leaves the methods all "
       "points.",
       look_for_truncation},
  };
}

}  // namespace raymoval::inspection
