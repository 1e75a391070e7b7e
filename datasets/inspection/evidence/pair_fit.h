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

/// Below this agreement two scans do not show enough of the same.
inline constexpr double kTooLittle = 0.25;

/// Metres at which a turn moves what is seen: it makes turns and shifts comparable.
inline constexpr double kTurnLever = 10.0;

/// A motion of the sensor that two scans show, without their poses.
struct SeenMotion {
  ScanPair pair;
  Pose motion = Pose::Identity();  ///< T_from_to.
};

/// Those of some surfels that are poles.
std::vector<Surfel> poles_of(const std::vector<Surfel>& surfels);

/// Surfels of a scan that are compared with another one; some of them, if there are many.
std::vector<Surfel> thinned(const std::vector<Surfel>& all);

/// The pairs of scans, ready to be compared under any poses.
class PairFit {
 public:
  explicit PairFit(const Samples& samples);

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
  void find_best(const std::vector<PoseHypothesis>& hypotheses);
  [[nodiscard]] double mean_best() const;
  [[nodiscard]] bool says_something() const;
  /// Whether most of the pairs that agree enough contradict some poses. A narrow view of a road may
  /// have nothing but the ground and a rail, which look alike wherever along them it is.
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
  /// Whether poles, of which traffic has none, agree better under some poses than under the motions
  /// found. Where all drive alike, the sensor seems to stand among those who drive along.
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
  /// The motions of the pairs that agree enough, as `find_best` found them.
  [[nodiscard]] std::vector<SeenMotion> seen_motions() const;

 private:
  [[nodiscard]] double agreement(const ScanPair& pair, const Pose& motion) const;
  /// Whether a motion turns otherwise than the one found for pair `k`, or is another one along a
  /// direction that the scans tell.
  [[nodiscard]] bool contradicts(std::size_t k, const Pose& motion) const;
  Pose best_of(const ScanPair& pair, const std::vector<Pose>& starts, double& best) const;

  const Samples& samples_;
  std::map<std::size_t, SurfaceMap> maps_;
  std::map<std::size_t, std::vector<Surfel>> moving_;
  std::vector<double> best_;   ///< Agreement, by pair.
  std::vector<Pose> motions_;  ///< Where it is reached, by pair.
};

/// Whether the sensor turns by about the angles that its poses turn by, about whatever axis. This
/// does not depend on how the sensor is turned on the body that has the poses.
bool turns_as_much(const std::vector<Pose>& poses, const std::vector<SeenMotion>& seen);

/// T_body_sensor under which the poses of a body move as the scans do (hand-eye calibration, Park
/// and Martin 1994, with turns and ways weighed by `kTurnLever`): first with the best turn about z,
/// then with the best of all turns, which a motion along nearly one line leaves open. The position
/// is 0 in directions that the turns of the body do not show; there it changes no motion, either.
/// Nothing if the scans hardly move.
std::vector<Pose> mounts_on_body(const std::vector<Pose>& poses,
                                 const std::vector<SeenMotion>& seen);

/// "90 degrees about z", or roll, pitch and yaw.
std::string turn_text(const Eigen::Matrix3d& turn);

/// "0.85,0,0,0,0,0.70711,0.70711": what `--T-sensor` says of it.
std::string mounting_text(const Pose& mount);

}  // namespace raymoval::inspection
