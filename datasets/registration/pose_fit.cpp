// SPDX-License-Identifier: MIT
#include "datasets/registration/pose_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "core/angle.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/sampling.h"
#include "datasets/registration/register_scans.h"

namespace raymoval::registration {
namespace {

/// Metres between stations: this share of the median range, within bounds.
constexpr double kStrideShare = 0.4, kLeastStride = 0.5, kMostStride = 8.0;
constexpr double kMostTurn = 45.0 * kDegree;  // between stations
constexpr std::size_t kMostScans = 20;        // between stations
constexpr std::size_t kFarStations = 4;       // A slow drift adds up over so many stations.
/// A return is within so many strides of a station, after a path of at least so many strides.
constexpr double kReturnStrides = 1.5, kPathStrides = 6.0;
constexpr std::size_t kLeastMatched = 150;
constexpr double kLeastOverlap = 0.25;
constexpr std::size_t kBatch = 32;  // Pairs whose scans are in memory together.

using Pairs = std::vector<PairDistance>;

/// Length of the path up to each scan, metres.
std::vector<double> path_lengths(const std::vector<Pose>& poses) {
  std::vector<double> lengths(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    lengths[i] = lengths[i - 1] + (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return lengths;
}

double turn_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// The first and the last scan, and between them one after each stride, turn or number of scans.
std::vector<std::size_t> choose_stations(const std::vector<Pose>& poses,
                                         const std::vector<double>& lengths, double stride) {
  std::vector<std::size_t> stations = {0};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const std::size_t last = stations.back();
    if (lengths[i] - lengths[last] >= stride || i - last >= kMostScans ||
        turn_between(poses[last], poses[i]) >= kMostTurn || i + 1 == poses.size()) {
      stations.push_back(i);
    }
  }
  return stations;
}

/// For each station the nearest earlier one that the path came back to.
void add_returns(const std::vector<Pose>& poses, const std::vector<double>& lengths,
                 const std::vector<std::size_t>& stations, double stride, Pairs& pairs) {
  for (const std::size_t to : stations) {
    double nearest = kReturnStrides * stride;
    PairDistance pair{to, to};
    for (const std::size_t from : stations) {
      if (from >= to) break;
      // Drift in height does not hide a return.
      const double apart = (poses[from].translation() - poses[to].translation()).head<2>().norm();
      if (apart >= nearest || lengths[to] - lengths[from] < kPathStrides * stride) continue;
      nearest = apart;
      pair.from = from;
    }
    if (pair.from != to) pairs.push_back(pair);
  }
}

Pairs choose_pairs(const std::vector<Pose>& poses, double stride) {
  const std::vector<double> lengths = path_lengths(poses);
  const std::vector<std::size_t> stations = choose_stations(poses, lengths, stride);
  std::set<std::pair<std::size_t, std::size_t>> chosen;
  for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
    chosen.emplace(stations[k], stations[k] + 1);
    chosen.emplace(stations[k], stations[k + 1]);
    if (k + kFarStations < stations.size()) {
      chosen.emplace(stations[k], stations[k + kFarStations]);
    }
  }
  Pairs pairs;
  for (const auto& [from, to] : chosen) pairs.push_back({from, to});
  add_returns(poses, lengths, stations, stride, pairs);
  return pairs;
}

/// The surfaces of the scans of a batch of pairs; those that the next batch shares are kept.
class SurfaceClouds {
 public:
  SurfaceClouds(const ScanSource& scans, int threads, const std::atomic<bool>* cancel)
      : scans_(scans), threads_(threads), cancel_(cancel) {}

  void load(const PairDistance* pairs, std::size_t count) {
    std::map<std::size_t, std::shared_ptr<const SurfaceCloud>> wanted;
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < 2 * count; ++i) {
      const std::size_t scan = i % 2 == 0 ? pairs[i / 2].from : pairs[i / 2].to;
      const auto found = clouds_.find(scan);
      const auto [place, is_new] =
          wanted.emplace(scan, found == clouds_.end() ? nullptr : found->second);
      if (is_new && place->second == nullptr) missing.push_back(scan);
    }
    clouds_ = std::move(wanted);
    parallel_for(threads_, missing.size(), 1, [&](std::size_t i) {
      if (cancel_ != nullptr && cancel_->load()) throw Cancelled();
      clouds_.at(missing[i]) = std::make_shared<SurfaceCloud>(scans_.load(missing[i]));
    });
  }
  [[nodiscard]] const SurfaceCloud& operator[](std::size_t scan) const { return *clouds_.at(scan); }

 private:
  const ScanSource& scans_;
  int threads_;
  const std::atomic<bool>* cancel_;
  std::map<std::size_t, std::shared_ptr<const SurfaceCloud>> clouds_;
};

}  // namespace

PoseFit measure_pose_fit(const ScanSource& scans, int threads, const std::atomic<bool>* cancel) {
  PoseFit fit;
  if (scans.size() < 2) return fit;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < scans.size(); ++i) poses.push_back(scans.pose(i));
  const double range = SurfaceCloud(scans.load(scans.size() / 2)).median_range();
  Pairs pairs = choose_pairs(poses, std::clamp(kStrideShare * range, kLeastStride, kMostStride));

  SurfaceClouds clouds(scans, threads, cancel);
  std::vector<double> distances, noises;
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, pairs.size() - begin);
    clouds.load(&pairs[begin], count);
    std::vector<Registration> found(count);
    parallel_for(threads, count, 1, [&](std::size_t i) {
      if (cancel != nullptr && cancel->load()) throw Cancelled();
      const auto [from, to, unused] = pairs[begin + i];
      found[i] = register_scans(clouds[from], clouds[to], poses[from].inverse() * poses[to]);
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (found[i].matched < kLeastMatched || found[i].overlap < kLeastOverlap) continue;
      distances.push_back(found[i].shift);
      noises.push_back(found[i].noise);
      fit.pairs.push_back({pairs[begin + i].from, pairs[begin + i].to, found[i].shift});
    }
  }
  std::sort(fit.pairs.begin(), fit.pairs.end(), [](const PairDistance& a, const PairDistance& b) {
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  });
  if (fit.pairs.empty()) return fit;
  fit.distance_m = median_in_place(distances);
  fit.noise_m = median_in_place(noises);
  return fit;
}

}  // namespace raymoval::registration
