// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/pair_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/angle.h"
#include "core/text.h"

namespace raymoval::inspection {
namespace {

constexpr std::size_t kMostSurfels = 1500;
/// Least number of surfels that constrain a direction: some are wrong, and normals of uneven ground
/// point a little along it.
constexpr double kFewestHolding = 12.0;
/// A motion differs if its rotation differs by more than this, radians, ...
constexpr double kOtherTurn = 5.0 * kDegree;
/// ... or its translation along constrained directions, metres. Roads rise by up to `kSlope`.
constexpr double kOtherShift = 0.2, kSlope = 0.2;

/// Adds forward motions of up to 3 m between scans.
void add_drives(std::vector<Pose>& starts) {
  for (const double ahead : {0.7, 1.4, 2.2, 3.0}) {
    Pose drive = Pose::Identity();
    drive.translation().x() = ahead;
    starts.push_back(drive);
  }
}

/// Adds the motion of the body for rotations of the sensor about z.
void add_turned(const Pose& motion, std::vector<Pose>& starts) {
  constexpr int kTurns = 8;
  for (int k = 1; k < kTurns; ++k) {
    const Pose turn(
        Eigen::AngleAxisd(2.0 * std::numbers::pi * k / kTurns, Eigen::Vector3d::UnitZ()));
    starts.push_back(turn.inverse() * motion * turn);
  }
}

}  // namespace

std::vector<Surfel> thinned(const std::vector<Surfel>& all) {
  if (all.size() <= kMostSurfels) return all;
  std::vector<Surfel> some;
  for (std::size_t i = 0; i < kMostSurfels; ++i) some.push_back(all[i * all.size() / kMostSurfels]);
  return some;
}

std::vector<Surfel> poles_of(const std::vector<Surfel>& surfels) {
  std::vector<Surfel> poles;
  std::copy_if(surfels.begin(), surfels.end(), std::back_inserter(poles),
               [](const Surfel& surfel) { return surfel.is_line(); });
  return poles;
}

PairFit::PairFit(const Samples& samples) : samples_(samples) {
  for (const ScanPair& pair : samples.pairs()) {
    maps_.try_emplace(pair.from, samples.surfels(pair.from));
    if (moving_.count(pair.to) == 0) moving_[pair.to] = thinned(samples.surfels(pair.to));
  }
}

double PairFit::agreement(const ScanPair& pair, const Pose& motion) const {
  return maps_.at(pair.from).agreement(moving_.at(pair.to), motion);
}

void PairFit::find_best(const std::vector<PoseHypothesis>& hypotheses) {
  best_.assign(samples_.pairs().size(), 0.0);
  motions_.assign(samples_.pairs().size(), Pose::Identity());
  Pose last = Pose::Identity();  // Motion of neighbours, a guess for scans farther apart.
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
    if (pair.to == pair.from + 1 && !hypotheses.empty()) {
      add_turned(starts.front(), starts);
      add_drives(starts);
    }
    motions_[k] = best_of(pair, starts, best_[k]);
    if (pair.to == pair.from + 1) last = motions_[k];
  }
}

double PairFit::mean_best() const {
  double sum = 0.0;
  for (const double best : best_) sum += best;
  return best_.empty() ? 0.0 : sum / static_cast<double>(best_.size());
}

bool PairFit::is_informative() const {
  return std::any_of(best_.begin(), best_.end(), [](double b) { return b >= kTooLittle; });
}

bool PairFit::contradicts(std::size_t k, const Pose& motion) const {
  const Pose& found = motions_[k];
  const Eigen::AngleAxisd turn(found.linear().transpose() * motion.linear());
  if (turn.angle() > kOtherTurn) return true;
  const Eigen::Vector3d shift = motion.translation() - found.translation();
  const std::vector<Surfel>& surfels = samples_.surfels(samples_.pairs()[k].from);
  return held_part(shift, surfels, kFewestHolding).norm() > kOtherShift + kSlope * shift.norm();
}

std::vector<RegisteredMotion> PairFit::registered_motions() const {
  std::vector<RegisteredMotion> seen;
  for (std::size_t k = 0; k < best_.size(); ++k) {
    if (best_[k] >= kTooLittle) seen.push_back({samples_.pairs()[k], motions_[k]});
  }
  return seen;
}

Pose PairFit::best_of(const ScanPair& pair, const std::vector<Pose>& starts, double& best) const {
  Pose found = starts.front();
  for (const Pose& start : starts) {
    const Pose refined = maps_.at(pair.from).refine(moving_.at(pair.to), start);
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

namespace {

Eigen::Vector3d turn_vector(const Pose& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  return turn.angle() * turn.axis();
}

Pose given_motion(const std::vector<Pose>& poses, const ScanPair& pair) {
  return poses[pair.from].inverse() * poses[pair.to];
}

/// Rounds to `step`, without a sign before a zero.
std::string rounded_text(double value, double step) {
  const double rounded = std::round(value / step) * step;
  return number_text(std::round((rounded == 0.0 ? 0.0 : rounded) * 1e5) / 1e5);
}

}  // namespace

bool turns_as_much(const std::vector<Pose>& poses, const std::vector<RegisteredMotion>& seen) {
  constexpr double kSame = 0.02;  // radians
  std::size_t same = 0;
  for (const RegisteredMotion& one : seen) {
    const double given = turn_vector(given_motion(poses, one.pair)).norm();
    if (std::abs(given - turn_vector(one.motion).norm()) < kSame) ++same;
  }
  return !seen.empty() && 4 * same >= 3 * seen.size();
}

namespace {

/// R_body_sensor for a sensor at `position` on the body: the best about z, and the best of all.
std::array<Eigen::Matrix3d, 2> turns_on_body(const std::vector<Pose>& poses,
                                             const std::vector<RegisteredMotion>& seen,
                                             const Eigen::Vector3d& position) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const RegisteredMotion& one : seen) {
    const Pose given = given_motion(poses, one.pair);
    const Eigen::Vector3d way = given * position - position;  // Of the sensor, in the body's frame.
    moments += way * one.motion.translation().transpose();
    moments += kTurnLever * kTurnLever * turn_vector(given) * turn_vector(one.motion).transpose();
  }
  const double yaw = std::atan2(moments(1, 0) - moments(0, 1), moments(0, 0) + moments(1, 1));
  const Eigen::Matrix3d upright =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d proper = Eigen::Matrix3d::Identity();
  proper(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() > 0.0 ? 1.0 : -1.0;
  return {upright, svd.matrixU() * proper * svd.matrixV().transpose()};
}

/// Least squares of (R_given - I) t = R_body_sensor t_seen - t_given.
Eigen::Vector3d position_on_body(const std::vector<Pose>& poses,
                                 const std::vector<RegisteredMotion>& seen,
                                 const Eigen::Matrix3d& turn) {
  constexpr double kLeastTurn = 0.2;  // radians, all pairs together: else noise decides
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sides = Eigen::Vector3d::Zero();
  for (const RegisteredMotion& one : seen) {
    const Pose given = given_motion(poses, one.pair);
    const Eigen::Matrix3d part = given.linear() - Eigen::Matrix3d::Identity();
    squares += part.transpose() * part;
    sides += part.transpose() * (turn * one.motion.translation() - given.translation());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares);
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()[k] < kLeastTurn * kLeastTurn) continue;
    const Eigen::Vector3d direction = solver.eigenvectors().col(k);
    position += direction.dot(sides) / solver.eigenvalues()[k] * direction;
  }
  return position;
}

}  // namespace

std::vector<Pose> mounts_on_body(const std::vector<Pose>& poses,
                                 const std::vector<RegisteredMotion>& seen) {
  constexpr double kLeast = 1.0;  // metres of way, all pairs together
  constexpr int kRounds = 20;
  double way = 0.0;
  for (const RegisteredMotion& one : seen) way += one.motion.translation().norm();
  if (way < kLeast) return {};
  std::vector<Pose> mounts(2, Pose::Identity());
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    for (int round = 0; round < kRounds; ++round) {
      mounts[k].linear() = turns_on_body(poses, seen, mounts[k].translation())[k];
      mounts[k].translation() = position_on_body(poses, seen, mounts[k].linear());
    }
  }
  return mounts;
}

std::string turn_text(const Eigen::Matrix3d& turn) {
  constexpr double kUpright = 0.9962;  // Within 5 degrees.
  const double yaw = std::atan2(turn(1, 0), turn(0, 0));
  if (turn(2, 2) > kUpright) return rounded_text(yaw / kDegree, 1.0) + " degrees about z";
  const double roll = std::atan2(turn(2, 1), turn(2, 2));
  const double pitch = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0));
  return "roll " + rounded_text(roll / kDegree, 1.0) + ", pitch " +
         rounded_text(pitch / kDegree, 1.0) + ", yaw " + rounded_text(yaw / kDegree, 1.0) +
         " degrees";
}

std::string mounting_text(const Pose& mount) {
  Eigen::Quaterniond q(mount.linear());
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  std::vector<std::string> numbers;
  for (const double metres : mount.translation()) numbers.push_back(rounded_text(metres, 1e-3));
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) {
    numbers.push_back(rounded_text(value, 1e-5));
  }
  return join(numbers, ",");
}

}  // namespace raymoval::inspection
