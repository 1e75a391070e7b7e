// SPDX-License-Identifier: MIT
#include "datasets/registration/pose_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <set>

#include "core/angle.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/sampling.h"
#include "datasets/registration/register_scans.h"
#include "datasets/registration/station_grid.h"

namespace raymoval::registration {

std::vector<double> path_lengths(const std::vector<Pose>& poses) {
  std::vector<double> lengths(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    lengths[i] = lengths[i - 1] + (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return lengths;
}

namespace {

/// Distance between stations: this share of the median range, within bounds in metres.
constexpr double kStrideShare = 0.4, kLeastStride = 0.5, kMostStride = 8.0;
constexpr double kMostTurn = 45.0 * kDegree;  // between stations
constexpr std::size_t kMostScans = 20;        // between stations
constexpr std::size_t kFarStations = 4;       // A slow drift adds up over this many stations.
constexpr std::size_t kPairsBetween = 10;
/// A return to a place is within `kReturnStrides` strides of a station, after a path of at least
/// `kPathStrides` strides.
constexpr double kReturnStrides = 1.5, kPathStrides = 6.0;
constexpr double kLeastReturn = 4.5;  // metres
/// Errors in plan on a return: up to `kReturnSteps` steps in either direction are tried.
constexpr double kReturnStep = 1.5;  // metres
constexpr int kReturnSteps = 2;
constexpr std::size_t kLeastMatched = 150;
constexpr double kLeastOverlap = 0.25;
/// Least gain in overlap, and the larger gain that is needed if the shift of points is mostly along
/// the surfaces: less than `kMostlyAcross` of it is across them, but at least `kLeastAcross`.
constexpr double kClearGain = 1.2, kClearerGain = 1.3, kMostlyAcross = 0.4, kLeastAcross = 0.3;
/// Or the least gain in overlap of the surfaces across the shift.
constexpr double kFarGain = 2.0;
constexpr std::size_t kFewestPairs = 4;  // Fewer are no basis: one in some hundred is misjudged.
constexpr std::size_t kBatch = 32;       // Pairs whose scans are in memory together.

using Pairs = std::vector<PairDistance>;

double turn_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// The first and the last scan, and between them a scan after each stride, turn or number of scans.
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

/// For each station, adds the nearest earlier station to which the path returned.
void add_returns(const std::vector<Pose>& poses, const std::vector<double>& lengths,
                 const std::vector<std::size_t>& stations, double stride, Pairs& pairs) {
  StationGrid grid(poses, std::max(kReturnStrides * stride, kLeastReturn));
  std::size_t last = poses.size();
  for (const std::size_t to : stations) {
    const std::size_t from = grid.nearest(poses[to].translation(), to, [&](std::size_t station) {
      return lengths[to] - lengths[station] >= kPathStrides * stride;
    });
    if (from != to) pairs.push_back({from, to, 0.0, true});
    // A stationary sensor has many stations in one place; one is enough.
    if (last < poses.size() && lengths[to] - lengths[last] < 0.5 * stride) continue;
    grid.add(to);
    last = to;
  }
}

/// Stations with the scan in the middle before the next station, where most scans lie between. If
/// the poses stand still while the sensor moves, no station lies between.
std::set<std::pair<std::size_t, std::size_t>> pairs_between(
    const std::vector<std::size_t>& stations) {
  std::vector<std::size_t> order(stations.size() - 1);
  std::iota(order.begin(), order.end(), 0);
  const auto length = [&](std::size_t k) { return stations[k + 1] - stations[k]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return length(a) > length(b); });
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t k : order) {
    if (pairs.size() == kPairsBetween || length(k) < 2) break;
    pairs.emplace(stations[k], stations[k] + length(k) / 2);
  }
  return pairs;
}

Pairs choose_pairs(const std::vector<Pose>& poses, double stride) {
  const std::vector<double> lengths = path_lengths(poses);
  const std::vector<std::size_t> stations = choose_stations(poses, lengths, stride);
  std::set<std::pair<std::size_t, std::size_t>> chosen;
  for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
    chosen.emplace(stations[k], stations[k + 1]);
    if (k + kFarStations < stations.size()) {
      chosen.emplace(stations[k], stations[k + kFarStations]);
    }
  }
  for (const auto& pair : pairs_between(stations)) chosen.insert(pair);
  Pairs pairs;
  for (const auto& [from, to] : chosen) pairs.push_back({from, to});
  add_returns(poses, lengths, stations, stride, pairs);
  return pairs;
}

/// T_from_to of two poses, and of a pose `to` that is shifted in plan.
Pose motion_of(const Pose& from, const Pose& to, double x = 0.0, double y = 0.0) {
  return from.inverse() * Eigen::Translation3d(x, y, 0.0) * to;
}

std::vector<Pose> shifted_in_plan(const Pose& from, const Pose& to) {
  std::vector<Pose> motions;
  for (int x = -kReturnSteps; x <= kReturnSteps; ++x) {
    for (int y = -kReturnSteps; y <= kReturnSteps; ++y) {
      if (x != 0 || y != 0)
        motions.push_back(motion_of(from, to, kReturnStep * x, kReturnStep * y));
    }
  }
  return motions;
}

/// The surfaces of the scans of a batch of pairs; surfaces that the next batch needs are kept.
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
      throw_if_cancelled(cancel_);
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

namespace {

/// Whether a registration is conclusive: scans overlap enough, and if surfaces are moved far, they
/// fit clearly better, and points are not moved along surfaces much farther, as if these constrain
/// the motion too little (a narrow view of a wall). It is enough if the few surfaces across the
/// shift fit, such as poles and signs along a road.
bool is_clear(const Registration& found) {
  if (found.matched < kLeastMatched || found.overlap < kLeastOverlap) return false;
  if (found.shift <= kMostDistance) return true;
  if (found.overlap_across >= kLeastOverlap &&
      found.overlap_across >= kFarGain * found.overlap_across_of_guess) {
    return true;
  }
  const double across = found.shift / found.shift_of_points;
  const double gain = across >= kMostlyAcross ? kClearGain : kClearerGain;
  return across >= kLeastAcross && found.overlap >= gain * found.overlap_of_guess;
}

}  // namespace

const PairDistance& worst_pair(const PoseFit& fit) {
  return *std::max_element(
      fit.pairs.begin(), fit.pairs.end(),
      [](const PairDistance& a, const PairDistance& b) { return a.distance_m < b.distance_m; });
}

bool fits(const PoseFit& fit) {
  return fit.pairs.empty() || is_within_limits(fit.distance_m, worst_pair(fit).distance_m);
}

double measure_pair(const ScanSource& scans, std::size_t from, std::size_t to) {
  const SurfaceCloud first(scans.load(from)), second(scans.load(to));
  const Registration found =
      register_scans(first, second, scans.pose(from).inverse() * scans.pose(to));
  return is_clear(found) ? found.shift : 0.0;
}

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
      throw_if_cancelled(cancel);
      const PairDistance& pair = pairs[begin + i];
      const Pose &from = poses[pair.from], &to = poses[pair.to];
      found[i] = register_scans(clouds[pair.from], clouds[pair.to], motion_of(from, to),
                                pair.is_return ? shifted_in_plan(from, to) : std::vector<Pose>());
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_clear(found[i])) continue;
      distances.push_back(found[i].shift);
      noises.push_back(found[i].noise);
      fit.pairs.push_back(pairs[begin + i]);
      fit.pairs.back().distance_m = found[i].shift;
    }
  }
  std::sort(fit.pairs.begin(), fit.pairs.end(), [](const PairDistance& a, const PairDistance& b) {
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  });
  if (fit.pairs.size() < kFewestPairs) return {};
  fit.distance_m = median_in_place(distances);
  fit.noise_m = median_in_place(noises);
  return fit;
}

}  // namespace raymoval::registration
