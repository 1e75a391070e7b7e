// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/time_offset.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/evidence/pair_fit.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::inspection {
namespace {

constexpr std::size_t kPairs = 12, kFewestPairs = 4;
/// The usual error of a registered motion, metres.
constexpr double kUsualNoise = 0.03;
/// Largest shift, and longest time between the scans of a pair, seconds.
constexpr double kFarthest = 2.0, kLongest = 1.0;
/// Shift of poses to measure the dependence of their motion on the time, seconds.
constexpr double kNudge = 0.05;
/// Least shift that is clear, in seconds and in standard deviations.
constexpr double kLeastOffset = 0.025, kDeviations = 4.0;
constexpr std::size_t kFewestChanged = 3;

/// Distance between two motions, metres; rotations are multiplied by `kTurnLever`.
double distance(const Pose& a, const Pose& b) {
  const Pose between = a.inverse() * b;
  const double turn = Eigen::AngleAxisd(between.linear()).angle();
  return std::hypot(between.translation().norm(), kTurnLever * turn);
}

/// The motion of the poses over a pair of scans, at another time.
std::optional<Pose> motion_at(const Samples& samples, const ScanPair& pair, double shift) {
  const Sequence& sequence = samples.sequence();
  const Nanoseconds later = from_seconds(shift);
  const auto from = sequence.motion->at(sequence.stamps[pair.from] + later);
  const auto to = sequence.motion->at(sequence.stamps[pair.to] + later);
  if (!from || !to) return std::nullopt;
  return from->inverse() * *to;
}

/// How much the motion of a pair depends on the time, metres per second.
double dependence(const Samples& samples, const ScanPair& pair, double shift) {
  const auto before = motion_at(samples, pair, shift - kNudge);
  const auto after = motion_at(samples, pair, shift + kNudge);
  return before && after ? distance(*before, *after) / (2.0 * kNudge) : 0.0;
}

/// Whether poses are looked up by time, in the frame of the scans' poses.
bool goes_by_time(const Samples& samples) {
  constexpr double kSame = 1e-3;
  const Sequence& sequence = samples.sequence();
  if (sequence.motion == nullptr || sequence.motion->follows_scans()) return false;
  if (!sequence.topics.empty()) return false;  // The motion is that of one of the sensors.
  if (sequence.stamps.size() != samples.size() || samples.size() < 2) return false;
  for (const std::size_t scan : {std::size_t{0}, samples.size() - 1}) {
    const auto pose = sequence.motion->at(sequence.stamps[scan]);
    if (!pose || distance(*pose, samples.poses()[scan]) > kSame) return false;
  }
  return true;
}

/// For each section of the sequence, the pair whose motion depends most on the time.
std::vector<ScanPair> informative_pairs(const Samples& samples) {
  const std::vector<Nanoseconds>& stamps = samples.sequence().stamps;
  std::vector<ScanPair> chosen;
  for (std::size_t part = 0; part < kPairs; ++part) {
    ScanPair best;
    double most = 0.0;
    const std::size_t end = (part + 1) * samples.size() / kPairs;
    for (std::size_t from = part * samples.size() / kPairs; from < end; ++from) {
      std::size_t to = std::min(from + 8, samples.size() - 1);
      while (to > from + 1 && to_seconds(stamps[to] - stamps[from]) > kLongest) --to;
      if (to <= from) continue;
      const double depends = dependence(samples, {from, to}, 0.0);
      if (depends > most) {
        most = depends;
        best = {from, to};
      }
    }
    if (most > 0.0) chosen.push_back(best);
  }
  return chosen;
}

/// The standard deviation of a shift from pairs whose motions have an error of `noise` metres.
double deviation_of(const Samples& samples, const std::vector<ScanPair>& pairs, double shift,
                    double noise) {
  double squares = 0.0;
  for (const ScanPair& pair : pairs) {
    const double depends = dependence(samples, pair, shift);
    squares += depends * depends;
  }
  return squares > 0.0 ? noise / std::sqrt(squares) : 1e9;
}

/// Registers the scans of a pair, from its poses at several times.
std::optional<RegisteredMotion> registered_motion(const Samples& samples, const ScanPair& pair) {
  const SurfaceMap map(samples.surfels(pair.from));
  const std::vector<Surfel> moving = thinned(samples.surfels(pair.to));
  double best = kTooLittle;
  std::optional<RegisteredMotion> seen;
  for (const double shift : {0.0, -0.15, 0.15, -0.4, 0.4, -0.8, 0.8, -1.5, 1.5}) {
    const auto start = motion_at(samples, pair, shift);
    if (!start) continue;
    const Pose refined = map.refine(moving, *start);
    const double reached = map.agreement(moving, refined);
    if (reached <= best) continue;
    best = reached;
    seen = RegisteredMotion{pair, refined};
  }
  return seen;
}

/// The evidence of pairs of scans on shifts.
class ShiftFit {
 public:
  ShiftFit(const Samples& samples, const std::vector<ScanPair>& pairs) : samples_(samples) {
    for (const ScanPair& pair : pairs) {
      if (const auto seen = registered_motion(samples, pair)) seen_.push_back(*seen);
    }
  }

  [[nodiscard]] std::size_t size() const { return seen_.size(); }
  [[nodiscard]] std::vector<ScanPair> pairs() const {
    std::vector<ScanPair> pairs;
    for (const RegisteredMotion& one : seen_) pairs.push_back(one.pair);
    return pairs;
  }
  /// Distances by pair; negative beyond the times of the poses.
  [[nodiscard]] std::vector<double> distances(double shift) const {
    std::vector<double> all;
    for (const RegisteredMotion& one : seen_) {
      const auto motion = motion_at(samples_, one.pair, shift);
      all.push_back(motion ? distance(*motion, one.motion) : -1.0);
    }
    return all;
  }
  /// Robust mean of the distances: a pair with an error of metres may be a wrong registration and
  /// counts little more than others. Infinite beyond the times of the poses.
  [[nodiscard]] double cost(double shift) const {
    constexpr double kFar = 0.2;
    double sum = 0.0;
    std::size_t count = 0;
    for (const double off : distances(shift)) {
      if (off < 0.0) continue;
      sum += off * off / (off * off + kFar * kFar);
      ++count;
    }
    return 3 * count < 2 * size() ? HUGE_VAL : sum / static_cast<double>(count);
  }
  [[nodiscard]] double best_shift() const {
    constexpr double kCoarse = 0.02, kFine = 0.001;
    double best = 0.0, least = cost(0.0);
    const auto look = [&](double middle, double reach, double step) {
      const int steps = static_cast<int>(std::lround(reach / step));
      for (int k = -steps; k <= steps; ++k) {
        const double costs = cost(middle + k * step);
        if (costs >= least) continue;
        least = costs;
        best = middle + k * step;
      }
    };
    look(0.0, kFarthest, kCoarse);
    look(best, kCoarse, kFine);
    return best;
  }

 private:
  const Samples& samples_;
  std::vector<RegisteredMotion> seen_;
};

/// Median of the known distances.
double median_of(std::vector<double> distances) {
  std::erase_if(distances, [](double off) { return off < 0.0; });
  return distances.empty() ? 0.0 : median(std::move(distances));
}

}  // namespace

std::optional<TimeOffset> find_time_offset(Samples& samples) {
  if (!goes_by_time(samples)) return std::nullopt;
  const std::vector<ScanPair> pairs = informative_pairs(samples);
  if (pairs.size() < kFewestPairs) return std::nullopt;
  // With a steady motion, no scan is read, because the shift is undetermined.
  if (deviation_of(samples, pairs, 0.0, kUsualNoise) > kLeastOffset) return std::nullopt;
  const ShiftFit fit(samples, pairs);
  if (fit.size() < kFewestPairs) return std::nullopt;
  const double shift = fit.best_shift();
  const std::vector<double> given = fit.distances(0.0), shifted = fit.distances(shift);
  TimeOffset offset;
  offset.given_m = median_of(given);
  offset.shifted_m = median_of(shifted);
  offset.pairs = fit.size();
  const std::vector<ScanPair> told = fit.pairs();
  for (std::size_t k = 0; k < told.size(); ++k) {
    const auto before = motion_at(samples, told[k], 0.0),
               after = motion_at(samples, told[k], shift);
    if (!before || !after || distance(*before, *after) <= offset.shifted_m) continue;
    ++offset.changed;
    if (shifted[k] < given[k]) ++offset.better;
  }
  offset.deviation = deviation_of(samples, told, shift, offset.shifted_m);
  offset.seconds = shift;
  samples.measures.emplace_back("time_offset_s", offset.seconds);
  samples.measures.emplace_back("time_offset_deviation_s", offset.deviation);
  samples.measures.emplace_back("motion_off_m", offset.given_m);
  samples.measures.emplace_back("motion_off_with_time_offset_m", offset.shifted_m);
  return offset;
}

bool is_clear(const TimeOffset& offset) {
  return std::abs(offset.seconds) >= std::max(kLeastOffset, kDeviations * offset.deviation) &&
         offset.changed >= kFewestChanged && 4 * offset.better >= 3 * offset.changed;
}

std::string time_offset_option(const Samples& samples, const TimeOffset& offset) {
  const double all = samples.sequence().time_offset_s.value_or(0.0) + offset.seconds;
  return "--time-offset " + number_text(std::round(all * 1000.0) / 1000.0);
}

std::string time_offset_text(const TimeOffset& offset) {
  return "between scans where speed or heading change, the sensor moves as its poses do " +
         fixed_text(std::abs(offset.seconds), 3) + " s " +
         (offset.seconds > 0.0 ? "later" : "earlier") + ": at the times as they are, " +
         counted_text(offset.pairs, "pair") + " of scans differ from the poses by " +
         fixed_text(offset.given_m, 2) + " m (median; turns by what they move 10 m off), and by " +
         fixed_text(offset.shifted_m, 2) + " m with that shift";
}

Pose pose_with(const Samples& samples, const TimeOffset& offset, std::size_t scan) {
  const Sequence& sequence = samples.sequence();
  return sequence.motion->at(sequence.stamps[scan] + from_seconds(offset.seconds))
      .value_or(samples.poses()[scan]);
}

}  // namespace raymoval::inspection
