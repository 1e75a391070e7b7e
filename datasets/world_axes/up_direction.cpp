// SPDX-License-Identifier: MIT
#include "datasets/world_axes/up_direction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/angle.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/geometry/surface_patches.h"

namespace raymoval {
namespace {

/// "y" -> 1; empty for a text that names no axis.
std::optional<Eigen::Index> axis_named(const std::string& name) {
  if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') return std::nullopt;
  return name[0] - 'x';
}

}  // namespace

std::optional<Eigen::Vector3d> parse_up(const std::string& text) {
  const bool negative = text.starts_with('-');
  const bool is_signed = negative || text.starts_with('+');
  if (const auto axis = axis_named(text.substr(is_signed ? 1 : 0))) {
    return Eigen::Vector3d(Eigen::Vector3d::Unit(*axis) * (negative ? -1.0 : 1.0));
  }
  const auto numbers = parse_numbers(text, ',');
  if (!numbers || numbers->size() != 3) return std::nullopt;
  const Eigen::Vector3d up = Eigen::Map<const Eigen::Vector3d>(numbers->data());
  // Scaled first, so that no square overflows or vanishes.
  const double largest = up.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return std::nullopt;
  return Eigen::Vector3d((up / largest).normalized());
}

const char* up_source_name(UpDirection::Source source) {
  if (source == UpDirection::Source::kWorldZ) return "world z";
  return source == UpDirection::Source::kGiven ? "given" : "estimated";
}

std::string up_line(const UpDirection& up) {
  if (up.is_world_z()) return "";
  return "up is " + axis_text(up.direction) + " of the world (" +
         (up.source == UpDirection::Source::kGiven
              ? "as given"
              : "estimated from the scans; --up z overrides it") +
         ")";
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kScans = 8;
constexpr float kNearestPatch = 1.0F, kFarthestPatch = 100.0F;  ///< Metres from the sensor.
constexpr double kFarthestSurface = 30.0;  ///< Metres; beyond, only floor counts (drones).
constexpr double kMostArea = 4.0;          ///< Square metres that a patch counts for at most.

// The ground.
constexpr double kLowest = 0.3, kHighest = 8.0;  ///< Height of a sensor above it, metres.
constexpr double kNear = 20.0;                   ///< Metres from the sensor.
constexpr double kGroundSpread = 12.0;           ///< Degrees between pieces of one ground.
constexpr double kSensorPrior = 0.5, kWorldPrior = 0.2;
constexpr double kLeastGround = 4.0;  ///< Square metres per scan.

// Evidence against the usual direction.
constexpr double kMostFloor = 0.25;  ///< Floor of the usual direction, as a share of the other's.
constexpr double kMostFloorByPath = 0.67;  ///< The same if the path contradicts it, too.
constexpr double kMostSky = 0.5;           ///< Largest `open` under a sky, as a share of `closed`.
constexpr double kMostCeiling = 0.5;  ///< Share of `closed` or `open` above which it is a ceiling.
constexpr double kLeastPath = 0.5;    ///< Metres that a path extends in two directions.
constexpr double kFlatPath = 0.3;     ///< Extent of the path across them, as a share.

// Upright surfaces.
constexpr double kCone = 30.0;  ///< Largest angle of up to the ground's direction, degrees.
/// Penalty at the cone's edge, as a share of all sides; 0 at the ground's direction.
constexpr double kGroundPull = 0.15;
/// Penalty in the last steps, per squared sine of the angle to the ground's direction.
constexpr double kFinePull = 0.005;
constexpr double kOffGround = 30.0;  ///< Degrees from the ground's direction: beyond, not ground.
constexpr double kUpright = 2.0;     ///< Largest lean of upright surfaces, degrees.

// The decision.
constexpr double kIntendedAxis = 40.0;  ///< Degrees: so near to the ground's normal, `usual` stays.
constexpr double kLeastTilt = 8.0;      ///< Degrees
constexpr double kSteepest = 30.0;      ///< Degrees: no vehicle's path is steeper as a whole.
constexpr double kLeastShare = 0.12;    ///< Of surfaces that are not ground.
constexpr double kLeastUpright = 4.0;   ///< Square metres per scan.
constexpr double kTimesBetter = 1.5;

double cosine(double degrees) {
  return std::cos(degrees * kDegree);
}
double sine(double degrees) {
  return std::sin(degrees * kDegree);
}

/// A patch in the world's axes.
struct Surface {
  Vector3d normal = Vector3d::UnitZ();  ///< Towards the sensor.
  Vector3d from_sensor = Vector3d::Zero();
  double weight = 0.0;
};

struct Surfaces {
  std::vector<Surface> all;              ///< Within `kFarthestSurface`.
  std::vector<Surface> far;              ///< Beyond.
  Vector3d sensor_z = Vector3d::Zero();  ///< Mean.
  double scans = 0.0;
};

Surfaces collect(const ScanSource& scans) {
  Surfaces surfaces;
  const std::vector<std::size_t> chosen = evenly_spread(scans.size(), kScans);
  for (const std::size_t index : chosen) {
    const Scan scan = scans.load(index);
    const Matrix3d turn = scan.T_world_sensor.linear();
    for_each_patch(
        scan, kNearestPatch, kFarthestPatch, [&](const SurfacePatch& patch, auto /*points*/) {
          auto& some = patch.mean.norm() > kFarthestSurface ? surfaces.far : surfaces.all;
          some.push_back({turn * patch.normal, turn * patch.mean, std::min(patch.area, kMostArea)});
        });
    surfaces.sensor_z += turn.col(2) / static_cast<double>(chosen.size());
    surfaces.scans += 1.0;
  }
  return surfaces;
}

/// A smooth weight: 1 at 0 and 0 from `reach` on.
double bump(double value, double reach) {
  const double share = 1.0 - value * value / (reach * reach);
  return share > 0.0 ? share * share : 0.0;
}

/// Weight of `surface` as ground if up is `up`: below the sensor and facing it.
double ground_weight(const Surface& surface, const Vector3d& up) {
  const double below = -surface.from_sensor.dot(up);
  if (below < kLowest || below > kHighest || surface.from_sensor.norm() > kNear) return 0.0;
  const double along = surface.normal.dot(up);
  if (along < cosine(kGroundSpread)) return 0.0;
  return surface.weight * (along - cosine(kGroundSpread)) / (1.0 - cosine(kGroundSpread));
}

/// Mean normal of the ground if up is about `up`. @param support square metres
Vector3d refined_ground(const Surfaces& surfaces, const Vector3d& up, double& support) {
  Vector3d sum = Vector3d::Zero();
  support = 0.0;
  for (const Surface& surface : surfaces.all) {
    const double weight = ground_weight(surface, up);
    sum += weight * surface.normal;
    support += weight;
  }
  return support > 0.0 ? sum.normalized() : up;
}

/// About evenly spaced directions within `cone` degrees of `axis`, `axis` first.
std::vector<Vector3d> directions_around(const Vector3d& axis, double cone, double step) {
  const Matrix3d turn = turn_to_z(axis).transpose();
  std::vector<Vector3d> directions = {axis};
  for (double polar = step; polar <= cone + 1e-9; polar += step) {
    const int count = std::max(6, static_cast<int>(std::lround(360.0 * sine(polar) / step)));
    for (int k = 0; k < count; ++k) {
      const double azimuth = 360.0 * kDegree * k / count;
      directions.push_back(turn * Vector3d(sine(polar) * std::cos(azimuth),
                                           sine(polar) * std::sin(azimuth), cosine(polar)));
    }
  }
  return directions;
}

/// The normal of the ground; zero if there is none. @param usual the usual up direction
Vector3d find_ground(const Surfaces& surfaces, const Vector3d& usual) {
  Vector3d best = Vector3d::Zero();
  double most = 0.0, area = 0.0;
  for (const Vector3d& up : directions_around(Vector3d::UnitZ(), 180.0, 6.0)) {
    double support = 0.0;
    refined_ground(surfaces, up, support);
    const double score =
        support * (1.0 + kSensorPrior * up.dot(surfaces.sensor_z) + kWorldPrior * up.dot(usual));
    if (score <= most) continue;
    most = score;
    area = support;
    best = up;
  }
  if (area < kLeastGround * surfaces.scans) return Vector3d::Zero();
  for (int k = 0; k < 5; ++k) best = refined_ground(surfaces, best, area);
  return best;
}

/// Surfaces that are not the ground.
struct Sides {
  std::vector<Surface> all;
  double area = 0.0;

  /// Area of upright surfaces if up is `up`. @param reach degrees
  [[nodiscard]] double upright(const Vector3d& up, double reach) const {
    const double limit = sine(reach);
    double sum = 0.0;
    for (const Surface& side : all) sum += side.weight * bump(side.normal.dot(up), limit);
    return sum;
  }

  /// The direction with the least lean (squared sines) of surfaces that are upright under `up`.
  [[nodiscard]] Vector3d least_leaning(const Vector3d& up, const Vector3d& ground) const {
    const double limit = sine(kUpright);
    // The ground decides directions that the sides do not constrain.
    Matrix3d moments = kFinePull * area * (Matrix3d::Identity() - ground * ground.transpose());
    for (const Surface& side : all) {
      const double weight = side.weight * bump(side.normal.dot(up), limit);
      moments += weight * side.normal * side.normal.transpose();
    }
    const Vector3d axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(moments).eigenvectors().col(0);
    return axis.dot(up) < 0.0 ? Vector3d(-axis) : axis;
  }
};

Sides sides_of(const Surfaces& surfaces, const Vector3d& ground) {
  Sides sides;
  for (const Surface& surface : surfaces.all) {
    if (std::abs(surface.normal.dot(ground)) > cosine(kOffGround)) continue;
    sides.all.push_back(surface);
    sides.area += surface.weight;
  }
  return sides;
}

/// The direction to which most sides are parallel. The ground's direction breaks ties: parallel
/// sides do not determine the lean of up along them.
Vector3d find_upright(const Sides& sides, const Vector3d& ground) {
  Vector3d best = ground;
  const auto search = [&](double cone, double step, double reach) {
    double most = -1e300;
    Vector3d found = best;
    for (const Vector3d& up : directions_around(best, cone, step)) {
      const double away = std::acos(std::clamp(up.dot(ground), -1.0, 1.0)) / (kCone * kDegree);
      const double score = sides.upright(up, reach) - kGroundPull * sides.area * away * away;
      if (score <= most) continue;
      most = score;
      found = up;
    }
    best = found;
  };
  search(kCone, 3.0, 2.5 * kUpright);
  search(3.0, 1.0, 1.5 * kUpright);
  for (int k = 0; k < 10; ++k) best = sides.least_leaning(best, ground);
  return best;
}

/// Area of the surfaces below the sensor that face `up`, at any distance, square metres. Points in
/// another frame than the sensor's may have their origin on the floor.
double floor_area(const Surfaces& surfaces, const Vector3d& up) {
  double area = 0.0;
  for (const auto* some : {&surfaces.all, &surfaces.far}) {
    for (const Surface& surface : *some) {
      const double below = -surface.from_sensor.dot(up), along = surface.normal.dot(up);
      const bool is_below = below > kLowest && along > 0.0;
      if (!is_below && std::abs(below) > kLowest) continue;
      if (std::abs(along) >= cosine(2.0 * kGroundSpread)) area += surface.weight;
    }
  }
  return area;
}

/// The normal of the path if it extends in two directions; else zero.
Vector3d normal_of_path(const ScanSource& scans) {
  Vector3d mean = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();
  const auto count = static_cast<double>(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) mean += scans.pose(i).translation() / count;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Vector3d offset = scans.pose(i).translation() - mean;
    squares += offset * offset.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(squares);
  const Vector3d extents = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (extents[1] < kLeastPath || extents[0] > kFlatPath * extents[1]) return Vector3d::Zero();
  return solver.eigenvectors().col(0);
}

/// Whether up is about `ground` and not `usual`. Facades beside a drone and the ceiling above a
/// robot look like ground, too. So one of these must hold: the floor below is missing and no second
/// facade faces the first; the path shows it; or only the other direction has an open sky.
bool is_contradicted(const Vector3d& usual, const Vector3d& ground, const Surfaces& surfaces,
                     const Vector3d& path) {
  const double floor = floor_area(surfaces, usual), other = floor_area(surfaces, ground);
  const bool is_turned = std::abs(ground.dot(usual)) < 0.5;  // And not upside down.
  if (is_turned && !path.isZero()) {
    if (std::abs(path.dot(usual)) > 0.8) return false;
    if (std::abs(path.dot(ground)) > 0.8) return floor < kMostFloorByPath * other;
  }
  // Surfaces opposite the floor and the ground: a ceiling, a second facade, or almost none (sky).
  const double closed = std::min(1.0, floor_area(surfaces, -usual) / std::max(floor, 1.0));
  const double open = floor_area(surfaces, -ground) / std::max(other, 1.0);
  if (is_turned && closed > kMostCeiling && open < kMostSky * closed) return true;
  return floor < kMostFloor * other && !(is_turned && open > kMostCeiling);
}

Vector3d intended_axis(const Vector3d& ground, const Vector3d& usual) {
  if (ground.dot(usual) >= cosine(kIntendedAxis)) return usual;
  Eigen::Index axis = 0;
  ground.cwiseAbs().maxCoeff(&axis);
  return Vector3d::Unit(axis) * (ground[axis] < 0.0 ? -1.0 : 1.0);
}

}  // namespace

GravityEvidence estimate_gravity(const ScanSource& scans, const Vector3d& usual) {
  GravityEvidence evidence;
  evidence.up.direction = evidence.upright = usual;
  const Surfaces surfaces = collect(scans);
  evidence.ground = find_ground(surfaces, usual);
  if (evidence.ground.isZero()) return evidence;
  if (evidence.ground.dot(usual) < cosine(kIntendedAxis) &&
      !is_contradicted(usual, evidence.ground, surfaces, normal_of_path(scans))) {
    double area = 0.0;
    evidence.ground = refined_ground(surfaces, usual, area);
    if (area < kLeastGround * surfaces.scans) return evidence;
  }
  const Vector3d axis = intended_axis(evidence.ground, usual);
  const Sides sides = sides_of(surfaces, evidence.ground);
  evidence.upright = find_upright(sides, evidence.ground);
  bool clear = evidence.ground.dot(axis) < cosine(kSteepest);
  if (sides.area > 0.0) {
    const double agree = sides.upright(evidence.upright, kUpright);
    evidence.share_upright = agree / sides.area;
    evidence.share_axis = sides.upright(axis, kUpright) / sides.area;
    clear |= evidence.share_upright >= kLeastShare && agree >= kLeastUpright * surfaces.scans &&
             evidence.share_upright >= kTimesBetter * evidence.share_axis;
  }
  const bool tilted = evidence.upright.dot(axis) < cosine(kLeastTilt);
  evidence.up.direction = tilted && clear ? evidence.upright : axis;
  if (evidence.up.direction != usual) evidence.up.source = UpDirection::Source::kEstimated;
  return evidence;
}

UpChoice::UpChoice(const std::optional<Eigen::Vector3d>& given) {
  if (!given) return;
  known_ = up_ = UpDirection{*given, UpDirection::Source::kGiven};
}

const UpDirection& UpChoice::get(const ScanSource& scans) const {
  std::call_once(once_, [&] {
    if (!up_) up_ = estimate_gravity(scans).up;
  });
  return *up_;
}

}  // namespace raymoval
