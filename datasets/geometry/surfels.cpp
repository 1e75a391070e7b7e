// SPDX-License-Identifier: MIT
#include "datasets/geometry/surfels.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raymoval {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kCell = 0.8;             // metres, edge of the cells that points are gathered in
constexpr std::size_t kFewestPoints = 6;  // points of a surfel
constexpr double kMostSpread = 0.05;      // metres, standard deviation across a surface
constexpr double kBreadth = 0.12;         // metres, standard deviation along a plane's short side
constexpr double kLookup = 1.6;           // metres, edge of the cells that surfels are found in
constexpr double kSameNormal = 0.85;      // cosine between surfels that may be the same surface
constexpr std::size_t kFewestOfGroup = 12;
constexpr std::size_t kGroups = 4;

/// Key of a cell. Distant cells may share a key, which costs only time.
std::uint64_t cell_name(double x, double y, double z) {
  const auto part = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value)) & 0x1FFFFFU;
  };
  return (part(z) << 42U) | (part(y) << 21U) | part(x);
}

bool nameable(const Vector3d& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() < 1e9;
}

std::uint64_t cell_of(const Vector3d& point, double edge) {
  return cell_name(std::floor(point.x() / edge), std::floor(point.y() / edge),
                   std::floor(point.z() / edge));
}

struct Moments {
  std::size_t count = 0;
  Vector3d origin = Vector3d::Zero(), sum = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();

  void add(const Vector3d& point) {
    if (count++ == 0) origin = point;
    const Vector3d offset = point - origin;
    sum += offset;
    squares += offset * offset.transpose();
  }
};

Surfel::Group group_of(const Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<Surfel::Group>(axis);
}

/// Accepts planes and upright lines. A horizontal line is one beam on the ground, which moves with
/// the sensor.
bool make_surfel(const Moments& moments, Surfel& surfel) {
  if (moments.count < kFewestPoints) return false;
  const auto count = static_cast<double>(moments.count);
  const Vector3d mean = moments.sum / count;
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(moments.squares / count - mean * mean.transpose());
  const Vector3d spread = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  surfel.mean = moments.origin + mean;
  if (spread[0] < kMostSpread && spread[1] > kBreadth) {
    surfel.axis = solver.eigenvectors().col(0);
    surfel.group = group_of(surfel.axis);
    return true;
  }
  surfel.axis = solver.eigenvectors().col(2);
  surfel.group = Surfel::Group::kLine;
  return spread[1] < kBreadth && spread[2] > 2.0 * spread[1] && spread[2] > kBreadth &&
         std::abs(surfel.axis.z()) > 0.9;
}

Surfel moved_by(const Pose& motion, const Surfel& surfel) {
  return {motion * surfel.mean, motion.linear() * surfel.axis, surfel.group};
}

/// Projects out the directions that a surface does not constrain: in the plane, or along the pole.
Matrix3d across(const Surfel& surfel) {
  const Matrix3d along = surfel.axis * surfel.axis.transpose();
  return surfel.is_line() ? Matrix3d(Matrix3d::Identity() - along) : along;
}

std::array<std::size_t, kGroups> group_sizes(const std::vector<Surfel>& surfels) {
  std::array<std::size_t, kGroups> sizes{};
  for (const Surfel& surfel : surfels) ++sizes[static_cast<std::size_t>(surfel.group)];
  return sizes;
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

std::vector<Eigen::Vector3f> without_near(std::vector<Eigen::Vector3f> points) {
  constexpr float kNear = 3.0F;
  std::erase_if(points, [](const Eigen::Vector3f& point) { return point.norm() < kNear; });
  return points;
}

std::vector<Surfel> find_surfels(const std::vector<Eigen::Vector3f>& points) {
  std::unordered_map<std::uint64_t, std::size_t> places;
  std::vector<Moments> cells;
  for (const Eigen::Vector3f& point : points) {
    const Vector3d p = point.cast<double>();
    if (!nameable(p)) continue;
    const auto [place, is_new] = places.emplace(cell_of(p, kCell), cells.size());
    if (is_new) cells.emplace_back();
    cells[place->second].add(p);
  }
  std::vector<Surfel> surfels;
  Surfel surfel;
  for (const Moments& cell : cells) {
    if (make_surfel(cell, surfel)) surfels.push_back(surfel);
  }
  return surfels;
}

Vector3d held_part(const Vector3d& shift, const std::vector<Surfel>& surfels, double fewest) {
  Matrix3d holding = Matrix3d::Zero();
  for (const Surfel& surfel : surfels) holding += across(surfel);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(holding);
  Vector3d held = Vector3d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3d direction = solver.eigenvectors().col(k);
    if (solver.eigenvalues()[k] >= fewest) held += direction.dot(shift) * direction;
  }
  return held;
}

SurfaceMap::SurfaceMap(std::vector<Surfel> surfels) : surfels_(std::move(surfels)) {
  for (std::size_t i = 0; i < surfels_.size(); ++i) {
    cells_[cell_of(surfels_[i].mean, kLookup)].push_back(static_cast<std::uint32_t>(i));
  }
}

const Surfel* SurfaceMap::nearest(const Surfel& moved) const {
  if (!nameable(moved.mean)) return nullptr;
  const Surfel* best = nullptr;
  double best_square = 0.25 * kLookup * kLookup;
  // The eight cells around the nearest corner extend half a cell or more to each side.
  const Vector3d corner = (moved.mean / kLookup).array().round();
  for (int k = 0; k < 8; ++k) {
    const auto found = cells_.find(
        cell_name(corner.x() - (k & 1), corner.y() - ((k >> 1) & 1), corner.z() - ((k >> 2) & 1)));
    if (found == cells_.end()) continue;
    for (const std::uint32_t i : found->second) {
      const Surfel& other = surfels_[i];
      const double square = (other.mean - moved.mean).squaredNorm();
      if (square >= best_square || other.is_line() != moved.is_line()) continue;
      if (std::abs(other.axis.dot(moved.axis)) < kSameNormal) continue;
      best_square = square;
      best = &other;
    }
  }
  return best;
}

double SurfaceMap::agreement(const std::vector<Surfel>& surfels, const Pose& motion,
                             double reach) const {
  std::array<double, kGroups> sums{};
  for (const Surfel& surfel : surfels) {
    const Surfel moved = moved_by(motion, surfel);
    const Surfel* other = nearest(moved);
    if (other == nullptr) continue;
    const double distance = (across(*other) * (moved.mean - other->mean)).norm();
    sums[static_cast<std::size_t>(surfel.group)] += std::max(0.0, 1.0 - distance / reach);
  }
  const auto sizes = group_sizes(surfels);
  double total = 0.0;
  int groups = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    if (sizes[g] < kFewestOfGroup) continue;
    total += sums[g] / static_cast<double>(sizes[g]);
    ++groups;
  }
  return groups == 0 ? 0.0 : total / groups;
}

Pose SurfaceMap::refine(const std::vector<Surfel>& surfels, const Pose& motion, int steps) const {
  const auto sizes = group_sizes(surfels);
  Pose best = motion;
  for (int step = 0; step < steps; ++step) {
    // A large scale at first, so that half a metre can be corrected.
    const double scale = std::max(0.1, 0.5 * std::pow(0.75, step));
    Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Identity() * 1e-9;
    Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
    const Vector3d centre = best.translation();
    for (const Surfel& surfel : surfels) {
      const Surfel moved = moved_by(best, surfel);
      const Surfel* other = nearest(moved);
      if (other == nullptr) continue;
      const Matrix3d P = across(*other);
      const Vector3d residual = P * (moved.mean - other->mean);
      const double robust = 1.0 / (1.0 + residual.squaredNorm() / (scale * scale));
      const double weight = robust * robust /
                            static_cast<double>(std::max(
                                kFewestOfGroup, sizes[static_cast<std::size_t>(surfel.group)]));
      Eigen::Matrix<double, 3, 6> jacobian;
      jacobian << P, -P * cross_matrix(moved.mean - centre);
      hessian += weight * jacobian.transpose() * jacobian;
      gradient += weight * jacobian.transpose() * residual;
    }
    const Eigen::Matrix<double, 6, 1> delta = -hessian.ldlt().solve(gradient);
    if (!delta.allFinite() || delta.head<3>().norm() > 5.0 || delta.tail<3>().norm() > 1.0) break;
    const double angle = delta.tail<3>().norm();
    if (angle > 1e-12) {
      best.linear() =
          Eigen::AngleAxisd(angle, delta.tail<3>() / angle).toRotationMatrix() * best.linear();
    }
    best.translation() = centre + delta.head<3>();
    if (delta.norm() < 1e-5) break;
  }
  return best;
}

}  // namespace raymoval
