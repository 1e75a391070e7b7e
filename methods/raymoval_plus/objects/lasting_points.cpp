// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/lasting_points.h"

#include <algorithm>
#include <cmath>

#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step.
/// Of the scans between the first and the last one that agree with what lasts, at least so many
/// times `settled_scans` agree when what is dynamic is not there, ...
constexpr double kSettledAround = 2.0;
/// ... and at least this share of those that could.
constexpr double kLeastAround = 0.8;

/// The numbers of some scans, counted from a cluster's own scan, which keeps sums small. Whole
/// numbers give the same sums in any order of the points.
struct ScanNumbers {
  std::int64_t sum = 0, squares = 0;

  void add(std::int64_t number) {
    sum += number;
    squares += number * number;
  }
  [[nodiscard]] double mean(double count) const { return static_cast<double>(sum) / count; }
  /// The standard deviation.
  [[nodiscard]] double deviation(double count) const {
    const double variance = static_cast<double>(squares) / count - mean(count) * mean(count);
    return std::sqrt(std::max(variance, 0.0));
  }
};

/// When the dynamic points of a cluster were where they are.
class DynamicPoints {
 public:
  /// @param scan the cluster's own
  void add(const VoxelEvidence& evidence, std::size_t scan) {
    own_scan_ = static_cast<std::int64_t>(scan);
    const AgreeingSpan scans = agreeing_span(evidence, scan);
    ++count_;
    first_.add(scans.first - own_scan_);
    last_.add(scans.last - own_scan_);
  }
  /// Whether a voxel was there long before these came or after they left. These were there from one
  /// standard deviation before the mean of the first scans that agree with them to one after the
  /// mean of the last ones. How many scans agree with the voxel in that time is not known; all that
  /// it has room for are taken to, so that those around it are not overrated.
  [[nodiscard]] bool are_outlasted_by(const VoxelEvidence& evidence,
                                      const Parameters& parameters) const {
    if (count_ == 0) return false;
    const auto count = static_cast<double>(count_);
    const double came = first_.mean(count) - first_.deviation(count);
    const double left = last_.mean(count) + last_.deviation(count);
    const auto first = static_cast<double>(evidence.first_agree - own_scan_);
    const auto last = static_cast<double>(evidence.last_agree - own_scan_);
    const double together = std::max(std::min(left, last) - std::max(came, first) + 1.0, 0.0);
    const double around = last - first + 1.0 - together;
    const double agree_around = evidence.agree_scans - together;
    return agree_around >= kSettledAround * parameters.settled_scans &&
           agree_around >= kLeastAround * around;
  }

 private:
  std::int64_t own_scan_ = 0, count_ = 0;
  ScanNumbers first_, last_;
};

}  // namespace

std::vector<std::uint8_t> lasting_points(const SegmentedScan& scan, const EvidenceMap& map,
                                         const std::vector<std::uint8_t>& may_last,
                                         const Parameters& parameters) {
  std::vector<std::uint8_t> lasting(scan.high_points.size(), 0);
  if (parameters.settled_scans == 0) return lasting;
  const auto for_points = [&](auto&& visit) {
    for (std::size_t i = 0; i < lasting.size(); ++i) {
      const std::uint32_t k = scan.high_points[i], voxel = scan.voxel[k];
      const auto cluster = static_cast<std::size_t>(scan.cluster_of[i]);
      if (may_last[cluster] == 0 || voxel == EvidenceMap::kNone) continue;
      visit(i, scan.verdict[k] == Verdict::kDynamic, map.evidence(voxel), cluster);
    }
  };
  std::vector<DynamicPoints> dynamic(scan.clusters.size());
  for_points([&](std::size_t, bool is_dynamic, const VoxelEvidence& evidence, std::size_t cluster) {
    if (is_dynamic) dynamic[cluster].add(evidence, scan.scan.index);
  });
  for_points(
      [&](std::size_t i, bool is_dynamic, const VoxelEvidence& evidence, std::size_t cluster) {
        lasting[i] = !is_dynamic && is_hardly_seen_through(evidence) &&
                     dynamic[cluster].are_outlasted_by(evidence, parameters);
      });
  return lasting;
}

}  // namespace raymoval::raymoval_plus_method
