// SPDX-License-Identifier: MIT
#include "core/scan/direction_pattern.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "core/angle.h"

namespace raymoval {
namespace {

constexpr std::size_t kFewest = 100;  ///< Least number of directions for a pattern.
constexpr double kLeastStep = 0.02 * kDegree, kWidestStep = 3.0 * kDegree;
constexpr double kReach = 2.0 * kWidestStep;  ///< Search radius for partners.
/// Visits of neighbours in all; keeps the time within a second for any number of points.
constexpr double kMostVisits = 1e7;
constexpr std::size_t kMostSamples = 4000;

double median_of(std::vector<double>& values, double quantile = 0.5) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::size_t samples_for(const Directions& scan, double reach, std::size_t scans) {
  const double visits = std::max(
      1.0, static_cast<double>(scan.size()) * std::min(1.0, reach / (2.0 * std::numbers::pi)));
  const double most = kMostVisits / static_cast<double>(scans) / visits;
  return std::clamp(static_cast<std::size_t>(most), std::size_t{50}, kMostSamples);
}

/// Whether a neighbour is beside a direction, like points of one beam; with a margin for slightly
/// inclined beams. `cosine` is that of the elevation of the direction.
bool beside(double azimuth, double rise, double cosine) {
  constexpr double kSlope = 0.25, kNoise = 0.02 * kDegree;
  return std::abs(rise) <= kSlope * azimuth * cosine + kNoise;
}

/// Share of directions that have a partner beside them, by distance in azimuth.
class PartnerShares {
 public:
  static constexpr std::size_t kBins = 144;
  static constexpr double kWidth = 0.04;  ///< Of a bin, relative to its distance.

  void add(const Directions& scan, std::size_t samples) {
    for (const std::size_t i : scan.sample(samples)) {
      const double cosine = std::cos(scan[i].elevation);
      std::bitset<kBins> partners;
      double nearest = kReach;
      scan.visit_ahead(i, kReach, [&](double azimuth, double rise) {
        if (azimuth < kLeastStep || !beside(azimuth, rise, cosine)) return;
        nearest = std::min(nearest, azimuth);
        set_about(azimuth, partners);
      });
      if (nearest < kReach) nearest_.push_back(nearest);
      for (std::size_t bin = 0; bin < kBins; ++bin) counts_[bin] += partners[bin] ? 1 : 0;
      ++samples_;
    }
  }

  [[nodiscard]] static double distance(std::size_t bin) {
    return kLeastStep * std::exp((static_cast<double>(bin) + 0.5) * kWidth);
  }

  /// The step at which the directions of a beam repeat; 0 if they do not.
  [[nodiscard]] double step() const {
    constexpr double kLeastShare = 0.5, kOfBest = 0.6;
    const double best = *std::max_element(counts_.begin(), counts_.end());
    for (std::size_t bin = 0; bin + 2 < kBins && distance(bin) <= kWidestStep; ++bin) {
      if (counts_[bin] < std::max(kOfBest * best, kLeastShare * samples_)) continue;
      if (counts_[bin] < counts_[bin + 1] || counts_[bin] < counts_[bin + 2]) continue;
      if (is_isolated_peak(bin)) return distance(middle_of_peak(bin));
    }
    return 0.0;
  }

  /// Mean distance to the next partner, where steps are uneven.
  [[nodiscard]] double mean_step() const {
    constexpr double kMissing = 5.0;  // Times the median: directions without return in between.
    std::vector<double> nearest = nearest_;
    if (nearest.empty()) return 0.0;
    const double limit = kMissing * median_of(nearest);
    std::sort(nearest.begin(), nearest.end());
    nearest.erase(std::upper_bound(nearest.begin(), nearest.end(), limit), nearest.end());
    return std::accumulate(nearest.begin(), nearest.end(), 0.0) /
           static_cast<double>(nearest.size());
  }

 private:
  static int bin_of(double azimuth) {
    return static_cast<int>(std::floor(std::log(azimuth / kLeastStep) / kWidth));
  }

  /// Steps of one sensor differ by a relative part and by the noise of its directions.
  static void set_about(double azimuth, std::bitset<kBins>& partners) {
    constexpr double kPart = 0.06, kNoise = 0.015 * kDegree;
    const double part = std::max(kPart * azimuth, std::min(kNoise, 0.25 * azimuth));
    const int last = std::min(bin_of(azimuth + part), static_cast<int>(kBins) - 1);
    for (int bin = std::max(0, bin_of(azimuth - part)); bin <= last; ++bin) {
      partners.set(static_cast<std::size_t>(bin));
    }
  }

  /// A peak is as wide as the tolerance of one step.
  [[nodiscard]] std::size_t middle_of_peak(std::size_t bin) const {
    constexpr double kLevel = 0.95;
    std::size_t first = bin, last = bin;
    while (first > 0 && counts_[first - 1] >= kLevel * counts_[bin]) --first;
    while (last + 1 < kBins && counts_[last + 1] >= kLevel * counts_[bin]) ++last;
    return (first + last) / 2;
  }

  /// Whether few directions have a partner at half as much again and at somewhat less than `bin`.
  [[nodiscard]] bool is_isolated_peak(std::size_t bin) const {
    constexpr double kBetween = 0.55;
    const auto mean = [&](double from, double to) {
      const int first = bin_of(from * distance(bin)), last = bin_of(to * distance(bin));
      double sum = 0.0;
      for (int at = std::max(first, 0); at <= std::min(last, static_cast<int>(kBins) - 1); ++at) {
        sum += counts_[static_cast<std::size_t>(at)];
      }
      return sum / (last - first + 1);
    };
    return mean(1.4, 1.6) <= kBetween * counts_[bin] && mean(0.5, 0.7) <= kBetween * counts_[bin];
  }

  std::array<double, kBins> counts_ = {};  ///< Whole numbers.
  std::vector<double> nearest_;
  double samples_ = 0.0;
};

/// Azimuth step as the median of the steps near `step`, and the change of a beam's elevation from
/// one column to the next.
std::pair<double, double> refined(const std::vector<Directions>& scans, double step) {
  constexpr double kNear = 0.08;
  std::vector<double> steps, rises;
  for (const Directions& scan : scans) {
    for (const std::size_t i : scan.sample(samples_for(scan, 2.0 * step, scans.size()))) {
      const double cosine = std::cos(scan[i].elevation);
      scan.visit_ahead(i, (1.0 + kNear) * step, [&](double azimuth, double rise) {
        if (azimuth < (1.0 - kNear) * step || !beside(azimuth, rise, cosine)) return;
        steps.push_back(azimuth);
        rises.push_back(std::abs(rise));
      });
    }
  }
  if (steps.empty()) return {step, 0.0};
  return {median_of(steps), median_of(rises)};
}

/// Whether neighbours lie beside each other rather than anywhere: a share of them that scattered
/// directions reach by a factor of two less.
bool neighbours_lie_beside(const std::vector<Directions>& scans, double spacing) {
  constexpr double kLevel = 0.15, kShare = 0.45, kSteepest = 60.0 * kDegree;
  std::size_t all = 0, level = 0;
  const double reach = 1.5 * spacing;
  for (const Directions& scan : scans) {
    for (const std::size_t i : scan.sample(samples_for(scan, 4.0 * reach, scans.size()))) {
      if (std::abs(scan[i].elevation) > kSteepest) continue;  // Azimuths run together above.
      const double scale = std::cos(scan[i].elevation);
      scan.visit_ahead(i, reach / scale, [&](double azimuth, double rise) {
        const double distance = std::hypot(azimuth * scale, rise);
        if (distance > reach || distance < kLeastStep) return;
        ++all;
        level += std::abs(rise) <= kLevel * reach ? 1 : 0;
      });
    }
  }
  return all > 0 && static_cast<double>(level) >= kShare * static_cast<double>(all);
}

/// Edge of the square that a direction of `scan` has to itself, where there are directions at all;
/// radians.
double spacing_of(const Directions& scan) {
  constexpr double kPerCell = 8.0, kFirstEdge = 0.25 * kDegree;
  double spacing = 0.0;
  for (double edge = kFirstEdge; edge < 40.0 * kDegree; edge *= 1.5) {
    std::unordered_set<std::int64_t> cells;
    double area = 0.0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      // Rows of cells of about equal area.
      const auto row = static_cast<std::int64_t>(std::floor(scan[i].elevation / edge));
      const double middle = std::min((static_cast<double>(row) + 0.5) * edge, 1.57);
      const double width = edge / std::max(0.02, std::cos(middle));
      const auto column = static_cast<std::int64_t>(std::floor(scan[i].azimuth / width));
      if (cells.insert(row * 100000 + column).second) area += edge * edge;
    }
    spacing = std::sqrt(area / static_cast<double>(scan.size()));
    if (static_cast<double>(scan.size()) >= kPerCell * static_cast<double>(cells.size())) break;
  }
  return spacing;
}

/// A direction and how far above it the next of its column lies.
struct Gap {
  double elevation;
  double rise;  ///< kNoRise if there is none.
};

constexpr double kNoRise = 12.0 * kDegree;  ///< No beams are as far apart.

/// Sorted by elevation.
std::vector<Gap> gaps_in_columns(const std::vector<Directions>& scans, double half_column,
                                 double least_rise) {
  constexpr std::size_t kSamples = 20000;
  std::vector<Gap> gaps;
  for (const Directions& scan : scans) {
    const std::size_t most =
        5 * samples_for(scan, 2.0 * half_column, scans.size());  // A bound, rarely reached.
    for (const std::size_t i : scan.sample(std::min(kSamples, most))) {
      double rise = kNoRise;
      scan.visit_around(i, half_column, [&](double, double up) {
        if (up > least_rise) rise = std::min(rise, up);
      });
      gaps.push_back({scan[i].elevation, rise});
    }
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) {
    return a.elevation != b.elevation ? a.elevation < b.elevation : a.rise < b.rise;
  });
  return gaps;
}

std::vector<Gap>::const_iterator first_from(const std::vector<Gap>& gaps, double elevation) {
  return std::lower_bound(gaps.begin(), gaps.end(), elevation,
                          [](const Gap& gap, double value) { return gap.elevation < value; });
}

/// The usual rise among `gaps` from the direction at `elevation`; where directions above have no
/// return it is longer, so the short ones count. kNoRise if next to nothing lies above.
double usual_rise(const std::vector<Gap>& gaps, double elevation, double reach) {
  constexpr double kLeastShare = 0.05, kShort = 0.3, kLonger = 1.5;
  std::vector<double> rises;
  std::size_t all = 0;
  const auto last = first_from(gaps, elevation + reach);
  for (auto gap = first_from(gaps, elevation - reach); gap != last; ++gap, ++all) {
    if (gap->rise < kNoRise) rises.push_back(gap->rise);
  }
  if (static_cast<double>(rises.size()) <= kLeastShare * static_cast<double>(all)) return kNoRise;
  const double limit = kLonger * median_of(rises, kShort);
  std::erase_if(rises, [&](double rise) { return rise > limit; });
  return median_of(rises);
}

/// Climbs from beam to beam.
void find_beams(const std::vector<Gap>& gaps, double low, double high, DirectionPattern& pattern) {
  constexpr int kMostBeams = 4096;
  constexpr double kSameBeam = 0.4;  // Of the rise to the next.
  std::vector<double> all;
  for (const Gap& gap : gaps) all.push_back(gap.rise);
  double rise = all.empty() ? kNoRise : median_of(all), at = low;
  pattern.beams = 1;
  while (pattern.beams < kMostBeams) {
    double next = usual_rise(gaps, at, kSameBeam * rise);
    if (next >= kNoRise) {
      // Its columns have no direction above this beam: continue with other columns.
      const auto above = first_from(gaps, at + kSameBeam * rise);
      if (above == gaps.end()) break;
      next = above->elevation - at;
    }
    if (at + next > high + kSameBeam * next) break;
    at += next;
    rise = next;
    ++pattern.beams;
  }
  if (pattern.beams > 1) pattern.elevation_step = (at - low) / (pattern.beams - 1);
}

double typical_spacing(const std::vector<Directions>& scans) {
  std::vector<double> spacings;
  for (const Directions& scan : scans) {
    if (scan.size() >= kFewest) spacings.push_back(spacing_of(scan));
  }
  return spacings.empty() ? 0.0 : median_of(spacings);
}

}  // namespace

DirectionPattern find_direction_pattern(const std::vector<Directions>& scans, double elevation_low,
                                        double elevation_high) {
  using Kind = DirectionPattern::Kind;
  DirectionPattern pattern;
  const double spacing = typical_spacing(scans);
  if (spacing <= 0.0) return pattern;
  PartnerShares shares;
  for (const Directions& scan : scans) shares.add(scan, samples_for(scan, kReach, scans.size()));
  const double step = shares.step();
  double half_column = 0.0, noise = 0.0;
  if (step > 0.0) {
    pattern.kind = Kind::kColumns;
    pattern.azimuth_step = step;
    for (int round = 0; round < 3; ++round) {
      std::tie(pattern.azimuth_step, noise) = refined(scans, pattern.azimuth_step);
    }
    half_column = 0.6 * pattern.azimuth_step;
  } else if (neighbours_lie_beside(scans, spacing)) {
    pattern.kind = Kind::kBeams;
    pattern.azimuth_step = shares.mean_step();
    half_column = 1.5 * pattern.azimuth_step;
  } else {
    pattern.kind = Kind::kScattered;
    pattern.azimuth_step = pattern.elevation_step = spacing;
    return pattern;
  }
  const double least_rise = std::max(0.02 * kDegree, 2.0 * noise);
  find_beams(gaps_in_columns(scans, half_column, least_rise), elevation_low, elevation_high,
             pattern);
  return pattern;
}

}  // namespace raymoval
