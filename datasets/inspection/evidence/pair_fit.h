// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "datasets/geometry/surfels.h"
#include "datasets/inspection/evidence/pose_hypotheses.h"
#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// Below this agreement, two scans do not have enough in common.
inline constexpr double kTooLittle = 0.25;

/// Lever arm, metres: converts rotations to distances, to compare them with translations.
inline constexpr double kTurnLever = 10.0;

/// A motion of the sensor from two scans, without their poses.
struct RegisteredMotion {
  ScanPair pair;
  Pose motion = Pose::Identity();  ///< T_from_to.
};

/// The poles among `surfels`.
std::vector<Surfel> poles_of(const std::vector<Surfel>& surfels);

/// The surfels of a scan for comparisons: a subset if there are many.
std::vector<Surfel> thinned(const std::vector<Surfel>& all);

/// The pairs of scans, to compare them under any poses.
class PairFit {
 public:
  explicit PairFit(const Samples& samples);

  /// Mean agreement over all pairs; each is at most the best agreement of the pair.
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

  /// Registers each pair, starting from the motions of `hypotheses` and from guesses.
  void find_best(const std::vector<PoseHypothesis>& hypotheses);
  [[nodiscard]] double mean_best() const;
  [[nodiscard]] bool is_informative() const;
  /// Whether most of the pairs with enough agreement contradict some poses. A narrow view of a road
  /// may have only the ground and a rail, which do not constrain the motion along them.
  template <class PoseOf>
  [[nodiscard]] bool contradict(PoseOf&& pose_of) const {
    std::size_t agree = 0, contrary = 0;
    for (std::size_t k = 0; k < samples_.pairs().size(); ++k) {
      const ScanPair& pair = samples_.pairs()[k];
      if (best_[k] < kTooLittle) continue;
      ++agree;
      if (contradicts(k, pose_of(pair.from).inverse() * pose_of(pair.to))) ++contrary;
    }
    return 2 * contrary > agree;
  }
  /// Whether poles agree better under some poses than under the registered motions. Among vehicles
  /// of one speed, registration may find no motion; but vehicles have no poles.
  template <class PoseOf>
  [[nodiscard]] bool poles_prefer(PoseOf&& pose_of) const {
    double preferred = 0.0;
    for (std::size_t k = 0; k < samples_.pairs().size(); ++k) {
      const ScanPair& pair = samples_.pairs()[k];
      const SurfaceMap& map = maps_.at(pair.from);
      const std::vector<Surfel> poles = poles_of(moving_.at(pair.to));
      preferred += map.agreement(poles, pose_of(pair.from).inverse() * pose_of(pair.to)) -
                   map.agreement(poles, motions_[k]);
    }
    return preferred > 0.0;
  }
  /// The registered motions of the pairs with enough agreement.
  [[nodiscard]] std::vector<RegisteredMotion> registered_motions() const;

 private:
  [[nodiscard]] double agreement(const ScanPair& pair, const Pose& motion) const;
  /// Whether a motion differs from the registered motion of pair `k` in rotation, or along a
  /// direction that the scans constrain.
  [[nodiscard]] bool contradicts(std::size_t k, const Pose& motion) const;
  Pose best_of(const ScanPair& pair, const std::vector<Pose>& starts, double& best) const;

  const Samples& samples_;
  std::map<std::size_t, SurfaceMap> maps_;
  std::map<std::size_t, std::vector<Surfel>> moving_;
  std::vector<double> best_;   ///< Best agreement, by pair.
  std::vector<Pose> motions_;  ///< Motion of the best agreement, by pair.
};

/// Whether the rotation angles of the sensor are about those of its poses; axes may differ. This
/// does not depend on the rotation of the sensor on the body.
bool turns_as_much(const std::vector<Pose>& poses, const std::vector<RegisteredMotion>& seen);

/// T_body_sensor that maps the motion of the poses to the motion of the scans (hand-eye
/// calibration, Park and Martin 1994, with rotations weighted by `kTurnLever`): first with the best
/// rotation about z, then with the best of all rotations, which a nearly straight motion does not
/// determine. The position is 0 in directions that the rotations of the body do not constrain;
/// there it changes no motion. Empty if the scans hardly move.
std::vector<Pose> mounts_on_body(const std::vector<Pose>& poses,
                                 const std::vector<RegisteredMotion>& seen);

/// "90 degrees about z", or roll, pitch and yaw.
std::string turn_text(const Eigen::Matrix3d& turn);

/// "0.85,0,0,0,0,0.70711,0.70711": the argument of `--T-sensor`.
std::string mounting_text(const Pose& mount);

}  // namespace raymoval::inspection
