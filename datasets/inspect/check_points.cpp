// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/file_kind.h"
#include "core/files.h"
#include "core/text.h"
#include "datasets/inspect/checks.h"
#include "datasets/inspect/pose_fit.h"

namespace raymoval::inspection {
namespace {

std::vector<Finding> look_for_millimetres(Samples& samples) {
  samples.measures.emplace_back("median_extent_m", samples.median_range());
  if (samples.point_scale() == 1.0) return {};
  Finding finding;
  finding.where = "points of all scans read";
  finding.what = "half of the points lie more than " + fixed_text(samples.median_range(), 0) +
                 " from the middle of their scan; taken as millimetres that is " +
                 fixed_text(samples.median_range() * samples.point_scale(), 1) + " m";
  return {finding};
}

/// Files write a missing return as a point at the sensor, in the world frame also as one at zero.
std::vector<Finding> look_for_origin(Samples& samples) {
  constexpr double kAtSensor = 0.05, kAtZero = 1e-3;
  std::size_t points = 0, scans = 0, first = 0;
  for (const auto& [index, scan] : samples.scans()) {
    std::size_t here = 0;
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d p = point.cast<double>();
      const bool at_zero = samples.stored_in_world() && (scan.T_world_sensor * p).norm() < kAtZero;
      if (p.norm() < kAtSensor || at_zero) ++here;
    }
    if (here > 0 && scans++ == 0) first = index;
    points += here;
  }
  if (points == 0) return {};
  Finding finding;
  finding.where = samples.scan_name(first);
  finding.what = grouped_text(points) + " points in " + grouped_text(scans) + " of " +
                 grouped_text(samples.scans().size()) +
                 " scans lie at the origin, where the sensor itself is";
  return {finding};
}

/// 16 KiB out of the middle of a file: enough to tell scans apart.
std::string middle_of(const std::filesystem::path& path, std::uintmax_t size) {
  constexpr std::uintmax_t kPiece = 16384;
  const std::uintmax_t piece = std::min(size, kPiece);
  return read_piece(path, (size - piece) / 2, static_cast<std::size_t>(piece));
}

/// Files that are compared byte by byte; where there are more copies, their middles will do.
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
      const auto [first, is_new] = seen.emplace(content_hash(middle_of(files[i].path, size)), i);
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
  Finding finding;
  finding.where = samples.scan_name(pairs.front().to);
  finding.what =
      "is the same scan as " + samples.scan_name(pairs.front().from) +
      (pairs.size() > 1 ? ", and there are " + grouped_text(pairs.size() - 1) + " more such pairs"
                        : "");
  return {finding};
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

/// A filter leaves a cliff: as many points just within its limit as before, none beyond, at the
/// same range in every scan. A sensor's own returns thin out.
std::vector<Finding> look_for_truncation(Samples& samples) {
  constexpr double kEqual = 0.02, kBand = 0.05, kCliff = 0.5, kLeast = 0.002;
  constexpr double kShareOfSensor = 0.6, kUnknownSensor = 60.0;
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
  const double usual =
      sensor.name == "estimated" ? kUnknownSensor : kShareOfSensor * sensor.range_max;
  const bool cliff = last >= kCliff * before && last / count >= kLeast;
  if (samples.scans().size() < 2 || farthest > usual || !cliff) return {};
  if (farthest - nearest > kEqual * farthest) return {};
  Finding finding;
  finding.where = "points of all scans read";
  finding.what = "every scan ends at " + fixed_text(farthest, 1) + " m with " +
                 fixed_text(100.0 * last / count, 1) + " % of its points in the last 5 % of it" +
                 (sensor.name == "estimated" ? std::string()
                                             : "; a " + sensor.name + " sees up to " +
                                                   fixed_text(sensor.range_max, 0) + " m");
  return {finding};
}

}  // namespace

std::vector<Check> point_checks() {
  return {
      {"points-in-millimetres", "points are millimetres", "metres",
       "Multiply the coordinates by 0.001.", look_for_millimetres},
      {"point-at-origin", "points at the origin stand for missing returns",
       "no point where there was no return",
       "Leave such points (and their labels) out, or write them as NaN.", look_for_origin},
      {"duplicated-scans", "a scan is there twice", "each scan once",
       "Remove the copy with its pose and labels, or leave it out with --frames.",
       look_for_duplicates},
      {"range-truncated", "points are cut off at a range", "all returns of the sensor",
       "Use unfiltered scans; --range MIN:MAX says what is evaluated without taking points from "
       "the methods.",
       look_for_truncation},
  };
}

}  // namespace raymoval::inspection
