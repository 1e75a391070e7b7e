// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/pose_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/evidence/pose_hypotheses.h"

namespace raymoval::inspection {
namespace {

/// Share of the best agreement that good poses reach; a drift of 10 cm between the scans of a pair
/// stays above it.
constexpr double kGood = 0.65;
/// Share that a hypothesis must reach, and by how much it has to beat the given poses.
constexpr double kNamed = 0.65;
constexpr double kBetter = 0.15;
/// Below this share, and with no hypothesis that explains it, poses and scans do not belong
/// together.
constexpr double kForeign = 0.5;
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

/// Surfels of one group whose coordinate along its axis, times `sign`, lies within the fullest half
/// metre beyond 0.3 m, as a share of all planes; `beyond` counts those farther out.
double fullest_level(const Samples& samples, Surfel::Group group, double sign, double& beyond) {
  constexpr double kLevel = 0.5, kNearest = 0.3;
  std::map<int, std::size_t> levels;
  std::size_t planes = 0;
  for (const auto& [index, scan] : samples.scans()) {
    for (const Surfel& surfel : samples.surfels(index)) {
      if (surfel.is_line() || surfel.mean.norm() > 20.0) continue;
      ++planes;
      const double level = sign * surfel.mean[static_cast<Eigen::Index>(group)];
      if (surfel.group == group && level > kNearest) ++levels[static_cast<int>(level / kLevel)];
    }
  }
  if (levels.empty()) return 0.0;
  const auto fullest =
      std::max_element(levels.begin(), levels.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  std::size_t far = 0;
  for (const auto& [level, count] : levels) far += level > fullest->first + 1 ? count : 0;
  beyond = static_cast<double>(far) / static_cast<double>(planes);
  return static_cast<double>(fullest->second) / static_cast<double>(planes);
}

/// Extent of the points of all scans along `axis`, a twentieth left out at either end.
double extent(const Samples& samples, Eigen::Index axis) {
  std::vector<float> values;
  for (const auto& [index, scan] : samples.scans()) {
    for (std::size_t i = 0; i < scan.size(); i += 50) values.push_back(scan.points[i][axis]);
  }
  std::sort(values.begin(), values.end());
  const std::size_t twentieth = values.size() / 20;
  return static_cast<double>(values[values.size() - 1 - twentieth] - values[twentieth]);
}

/// Whether the ground lies along +y, as in camera axes, and not along -z. A few beams (VLP-16) show
/// no plane of ground beside long walls; but then the scan is wide along y.
bool in_camera_axes(Samples& samples) {
  double beyond_y = 0.0, beyond_z = 0.0;
  const double y = fullest_level(samples, Surfel::Group::kNormalY, 1.0, beyond_y);
  const double z = fullest_level(samples, Surfel::Group::kNormalZ, -1.0, beyond_z);
  samples.measures.emplace_back("ground_along_minus_z", z);
  samples.measures.emplace_back("ground_along_y", y);
  if (y < 0.1 || y < 3.0 * z || beyond_y > 0.1) return false;
  return extent(samples, 1) < 0.7 * extent(samples, 2);
}

/// Motions alone do not tell points in camera axes from poses that were taken to a camera.
void look_at_axes(Samples& samples, PoseVerdict& verdict) {
  if (!verdict.check.empty() && verdict.check != "lidar-poses-as-camera") return;
  if (!in_camera_axes(samples)) return;
  verdict.what =
      "the ground lies along +y of the points: they stand in camera axes (x right, y down, z "
      "ahead)" +
      std::string(verdict.check.empty() ? ", and so do the poses" : ", but the poses do not");
  verdict.check = "camera-frame";
}

std::string percent(double share) {
  return fixed_text(100.0 * share, 0) + " %";
}

/// Middle of a scan's points, coordinate by coordinate.
Eigen::Vector3d middle_of(const Scan& scan) {
  Eigen::Vector3d middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (std::size_t i = 0; i < scan.size(); i += 10) values.push_back(scan.points[i][axis]);
    middle[axis] = static_cast<double>(median(std::move(values)));
  }
  return middle;
}

/// Whether the points go where the poses go, as points of the world frame do. Traffic that drives
/// along and a vehicle in view agree without poses, but stay around the sensor.
bool points_follow_poses(const Samples& samples) {
  constexpr double kFewest = 2.0;
  const auto& first = samples.scans().begin()->second;
  const auto& last = samples.scans().rbegin()->second;
  const Eigen::Vector3d way =
      last.T_world_sensor.translation() - first.T_world_sensor.translation();
  const Eigen::Vector3d moved = middle_of(last) - middle_of(first);
  return way.norm() >= kFewest && (moved - way).norm() < 0.5 * way.norm();
}

bool is_identity(const PoseHypothesis& hypothesis) {
  return hypothesis.check == "points-in-world" || hypothesis.check == "viewpoint-twice";
}

/// The hypothesis under which the scans agree best, and its share.
std::pair<PoseHypothesis, double> best_hypothesis(const Samples& samples, const PairFit& fit,
                                                  std::vector<PoseHypothesis> hypotheses) {
  for (PoseHypothesis& hypothesis : degree_hypotheses(samples)) {
    hypotheses.push_back(std::move(hypothesis));
  }
  const bool in_world = points_follow_poses(samples);
  std::pair<PoseHypothesis, double> best{{}, 0.0};
  for (const PoseHypothesis& hypothesis : hypotheses) {
    if (is_identity(hypothesis) && !in_world) continue;
    const double share = fit.share(hypothesis.pose);
    if (share > best.second) best = {hypothesis, share};
  }
  return best;
}

/// The largest of 100, 10, 1 and 0.1 m of which all positions along an axis that is far from the
/// origin are multiples; 0 if there is none.
double position_step(const std::vector<Pose>& poses) {
  constexpr double kFar = 1000.0, kLargest = 100.0, kSmallest = 0.05;
  double found = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double step = kLargest, farthest = 0.0;
    for (const Pose& pose : poses) {
      const double at = pose.translation()[axis];
      farthest = std::max(farthest, std::abs(at));
      while (step > kSmallest && std::abs(at / step - std::round(at / step)) > 1e-6) step /= 10.0;
    }
    if (farthest > kFar && step > kSmallest) found = std::max(found, step);
  }
  return found;
}

PoseVerdict compare_hypotheses(Samples& samples) {
  if (samples.pairs().empty()) return {};
  PairFit fit(samples);
  fit.find_best({});
  const auto given_pose = [&](std::size_t i) { return samples.poses()[i]; };
  double given = fit.share(given_pose);
  samples.measures.emplace_back("agreement", fit.mean_best());
  samples.measures.emplace_back("agreement_of_given_poses", given);
  if (fit.says_something() && given >= kGood) return {};

  const std::vector<PoseHypothesis> hypotheses = pose_hypotheses(samples);
  fit.find_best(hypotheses);
  given = fit.share(given_pose);
  if (!fit.says_something() || given >= kGood) return {};
  const auto [best, reached] = best_hypothesis(samples, fit, hypotheses);
  samples.measures.emplace_back("agreement_of_best_hypothesis", reached);
  const std::string now = "the scans agree to " + percent(given) + " under the poses";
  if (reached >= kNamed && reached > given + kBetter) {
    return {best.check, now + " and to " + percent(reached) + " " + best.phrase};
  }
  if (const double step = position_step(samples.poses()); step > 0.0) {
    return {"poses-coarse",
            now + ", whose positions are whole multiples of " + number_text(step) +
                " m along an axis: written far from the origin with too few digits"};
  }
  if (given >= kForeign) return {};
  return {"poses-of-another-sequence",
          now +
              " (100 % = registered to each other), and under no usual mistake of frames, units or "
              "order to more than " +
              percent(reached)};
}

}  // namespace

const PoseVerdict& pose_verdict(Samples& samples) {
  if (!samples.pose_verdict) {
    PoseVerdict verdict = compare_hypotheses(samples);
    look_at_axes(samples, verdict);
    samples.pose_verdict = verdict;
  }
  return *samples.pose_verdict;
}

}  // namespace raymoval::inspection
