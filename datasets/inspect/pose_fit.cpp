// SPDX-License-Identifier: MIT
#include "datasets/inspect/pose_fit.h"

#include <algorithm>

#include "core/text.h"
#include "datasets/inspect/pose_hypotheses.h"

namespace raymoval::inspection {
namespace {

/// Share of the best agreement that good poses reach; a drift of 10 cm between the scans of a pair
/// stays above it.
constexpr double kGood = 0.65;
/// Share that a hypothesis must reach, and by how much it has to beat the given poses.
constexpr double kNamed = 0.75;
constexpr double kBetter = 0.1;
/// Below this agreement two scans do not show enough of the same.
constexpr double kTooLittle = 0.25;
constexpr std::size_t kMostSurfels = 1500;

/// The pairs of scans, ready to be compared under any poses.
class PairFit {
 public:
  explicit PairFit(const Samples& samples) : samples_(samples) {
    for (const ScanPair& pair : samples.pairs()) {
      maps_.try_emplace(pair.from, samples.surfels(pair.from));
      if (moving_.count(pair.to) == 0) moving_[pair.to] = thinned(samples.surfels(pair.to));
    }
  }

  [[nodiscard]] double agreement(const ScanPair& pair, const Pose& motion) const {
    return maps_.at(pair.from).agreement(moving_.at(pair.to), motion);
  }
  [[nodiscard]] Pose refine(const ScanPair& pair, const Pose& motion) const {
    return maps_.at(pair.from).refine(moving_.at(pair.to), motion);
  }

  /// Mean agreement over all pairs, each at most its best.
  template <class PoseOf>
  [[nodiscard]] double share(PoseOf&& pose_of) const {
    double sum = 0.0, most = 0.0;
    for (std::size_t k = 0; k < samples_.pairs().size(); ++k) {
      const ScanPair& pair = samples_.pairs()[k];
      if (best_[k] < kTooLittle) continue;
      sum += std::min(best_[k], agreement(pair, pose_of(pair.from).inverse() * pose_of(pair.to)));
      most += best_[k];
    }
    return most > 0.0 ? sum / most : 1.0;
  }

  /// Registers each pair from the motions given and from guesses at the sensor's own.
  void find_best(const std::vector<PoseHypothesis>& hypotheses) {
    best_.assign(samples_.pairs().size(), 0.0);
    Pose last = Pose::Identity();  // Of neighbours, a guess for scans farther apart.
    for (std::size_t k = 0; k < samples_.pairs().size(); ++k) {
      const ScanPair& pair = samples_.pairs()[k];
      const auto& poses = samples_.poses();
      std::vector<Pose> starts = {poses[pair.from].inverse() * poses[pair.to], Pose::Identity()};
      for (const PoseHypothesis& hypothesis : hypotheses) {
        starts.push_back(hypothesis.pose(pair.from).inverse() * hypothesis.pose(pair.to));
      }
      Pose repeated = Pose::Identity();
      for (std::size_t step = pair.from; step < pair.to; ++step) repeated = repeated * last;
      starts.push_back(repeated);
      if (pair.to == pair.from + 1 && !hypotheses.empty()) add_drives(starts);
      const Pose found = best_of(pair, starts, best_[k]);
      if (pair.to == pair.from + 1) last = found;
    }
  }

  [[nodiscard]] double mean_best() const {
    double sum = 0.0;
    for (const double best : best_) sum += best;
    return best_.empty() ? 0.0 : sum / static_cast<double>(best_.size());
  }
  [[nodiscard]] bool says_something() const {
    return std::any_of(best_.begin(), best_.end(), [](double b) { return b >= kTooLittle; });
  }

 private:
  static std::vector<Surfel> thinned(const std::vector<Surfel>& all) {
    if (all.size() <= kMostSurfels) return all;
    std::vector<Surfel> some;
    for (std::size_t i = 0; i < kMostSurfels; ++i)
      some.push_back(all[i * all.size() / kMostSurfels]);
    return some;
  }
  /// A vehicle goes ahead by up to 3 m between scans.
  static void add_drives(std::vector<Pose>& starts) {
    for (const double ahead : {0.7, 1.4, 2.2, 3.0}) {
      Pose drive = Pose::Identity();
      drive.translation().x() = ahead;
      starts.push_back(drive);
    }
  }
  Pose best_of(const ScanPair& pair, const std::vector<Pose>& starts, double& best) const {
    Pose found = starts.front();
    for (const Pose& start : starts) {
      const Pose refined = refine(pair, start);
      for (const Pose& motion : {start, refined}) {
        const double reached = agreement(pair, motion);
        if (reached > best) {
          best = reached;
          found = motion;
        }
      }
    }
    return found;
  }

  const Samples& samples_;
  std::map<std::size_t, SurfaceMap> maps_;
  std::map<std::size_t, std::vector<Surfel>> moving_;
  std::vector<double> best_;
};

std::string percent(double share) {
  return fixed_text(100.0 * share, 0) + " %";
}

PoseVerdict judge(Samples& samples) {
  if (samples.pairs().empty()) return {};
  PairFit fit(samples);
  fit.find_best({});
  const auto given_pose = [&](std::size_t i) { return samples.poses()[i]; };
  double given = fit.share(given_pose);
  samples.measures.emplace_back("agreement", fit.mean_best());
  samples.measures.emplace_back("agreement_of_given_poses", given);
  if (given >= kGood) return {};

  std::vector<PoseHypothesis> hypotheses = pose_hypotheses(samples);
  fit.find_best(hypotheses);
  given = fit.share(given_pose);
  if (!fit.says_something() || given >= kGood) return {};
  for (PoseHypothesis& hypothesis : degree_hypotheses(samples)) {
    hypotheses.push_back(std::move(hypothesis));
  }
  const PoseHypothesis* best = nullptr;
  double reached = 0.0;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    const double share = fit.share(hypothesis.pose);
    if (share > reached) {
      reached = share;
      best = &hypothesis;
    }
  }
  samples.measures.emplace_back("agreement_of_best_hypothesis", reached);
  const std::string now = "the scans agree to " + percent(given) + " under the poses";
  if (best != nullptr && reached >= kNamed && reached > given + kBetter) {
    return {best->check, now + " and to " + percent(reached) + " " + best->phrase};
  }
  return {"poses-of-another-sequence",
          now +
              " (100 % = registered to each other), and under no usual mistake of frames, "
              "units or order to more than " +
              percent(reached)};
}

}  // namespace

const PoseVerdict& pose_verdict(Samples& samples) {
  if (!samples.pose_verdict) samples.pose_verdict = judge(samples);
  return *samples.pose_verdict;
}

}  // namespace raymoval::inspection
