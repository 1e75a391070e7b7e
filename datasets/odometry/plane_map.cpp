// SPDX-License-Identifier: MIT
#include "datasets/odometry/plane_map.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace raymoval::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::uint32_t kFewestPoints = 5;
constexpr std::uint32_t kFullCell = 200;  // More do not change a plane, and old ones do not drift.
/// Standard deviation across a plane: at most this share of the cell's edge, so that the foot of a
/// wall with some ground has no plane, or, in small cells, this noise of the sensor, metres.
constexpr float kMostThickness = 0.06F, kNoise = 0.025F;
/// Least and full standard deviation across a strip of points on a plane, of the cell's edge.
constexpr float kLeastWidth = 0.12F, kFullWidth = 0.29F;

/// The cells are turned against the frame of the map. Walls and floors are often parallel to the
/// axes of the first scan, and at round distances they would lie on the faces of cells.
Eigen::Matrix3d turn_of_cells() {
  static const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.6, Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  return turn;
}

}  // namespace

PlaneMap::PlaneMap(double cell_m) : cell_m_(cell_m) {
  for (int k = 0; k < kLevels; ++k) levels_[k].cell_m = cell_m * (1 << k);
}

Vector3d PlaneMap::centre_of(const Cell& cell, double cell_m) {
  return cell_m * (voxel_index(cell.key).cast<double>().array() + 0.5).matrix();
}

void PlaneMap::fit(Cell& cell, double cell_m) {
  cell.fitted = cell.count;
  const auto count = static_cast<float>(cell.count);
  const Vector3f mean = cell.sum / count;
  const auto& p = cell.products;
  Eigen::Matrix3f covariance;
  covariance << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
  covariance = covariance / count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const auto edge = static_cast<float>(cell_m);
  const float thickness = std::sqrt(std::max(solver.eigenvalues()[0], 0.0F));
  const float width = std::sqrt(std::max(solver.eigenvalues()[1], 0.0F));
  cell.is_rough = thickness > std::max(kMostThickness * edge, kNoise);
  const bool is_plane = !cell.is_rough && width >= kLeastWidth * edge && width > 3.0F * thickness;
  cell.mean = mean;
  cell.weight = std::min(1.0F, std::pow(width / (kFullWidth * edge), 4.0F));
  cell.normal = is_plane ? Vector3f(solver.eigenvectors().col(0)) : Vector3f::Zero();
}

void PlaneMap::add(Level& level, const std::vector<Vector3d>& points) {
  std::vector<std::uint32_t> touched;
  const double inverse = 1.0 / level.cell_m;
  for (const Vector3d& point : points) {
    const VoxelIndex index = voxel_index(point, inverse);
    const VoxelKey key = voxel_key(index);
    const auto [found, is_new] =
        level.numbers.try_emplace(key, static_cast<std::uint32_t>(level.cells.size()));
    if (is_new) level.cells.emplace_back().key = key;
    Cell& cell = level.cells[found->second];
    if (cell.count >= kFullCell) continue;
    const Vector3f at =
        (point - level.cell_m * (index.cast<double>().array() + 0.5).matrix()).cast<float>();
    if (cell.singles < kSingles) cell.points[cell.singles++] = at;
    cell.sum += at;
    cell.products[0] += at.x() * at.x();
    cell.products[1] += at.x() * at.y();
    cell.products[2] += at.x() * at.z();
    cell.products[3] += at.y() * at.y();
    cell.products[4] += at.y() * at.z();
    cell.products[5] += at.z() * at.z();
    ++cell.count;
    if (cell.count >= kFewestPoints && 4 * cell.count >= 5 * cell.fitted) {
      touched.push_back(found->second);
    }
  }
  for (const std::uint32_t number : touched) {
    Cell& cell = level.cells[number];
    if (cell.fitted != cell.count) fit(cell, level.cell_m);
  }
}

void PlaneMap::add(const std::vector<Vector3f>& points, const Pose& T_map_sensor) {
  const Pose T_cells_sensor = turn_of_cells() * T_map_sensor;
  std::vector<Vector3d> placed;
  placed.reserve(points.size());
  for (const Vector3f& point : points) placed.push_back(T_cells_sensor * point.cast<double>());
  for (Level& level : levels_) add(level, placed);
}

void PlaneMap::forget_beyond(const Vector3d& centre_of_map, double radius) {
  const Vector3d centre = turn_of_cells() * centre_of_map;
  for (Level& level : levels_) {
    std::vector<Cell> kept;
    for (const Cell& cell : level.cells) {
      if ((centre_of(cell, level.cell_m) - centre).squaredNorm() <= radius * radius) {
        kept.push_back(cell);
      }
    }
    if (kept.size() == level.cells.size()) continue;
    level.cells = std::move(kept);
    level.numbers.clear();
    for (std::uint32_t i = 0; i < level.cells.size(); ++i) {
      level.numbers.emplace(level.cells[i].key, i);
    }
  }
}

const PlaneMap::Cell* PlaneMap::Level::find(const Vector3d& at) const {
  const auto found = numbers.find(voxel_key(voxel_index(at, 1.0 / cell_m)));
  if (found == numbers.end()) return nullptr;
  const Cell& cell = cells[found->second];
  return cell.normal.isZero() && !cell.is_rough ? nullptr : &cell;
}

std::optional<Vector3d> PlaneMap::to_nearest(const Vector3d& at, double reach) const {
  const Level& level = levels_[0];
  const VoxelIndex low =
      voxel_index(at - Vector3d::Constant(0.5 * level.cell_m), 1.0 / level.cell_m);
  std::optional<Vector3d> best;
  double least = reach * reach;
  for (int i = 0; i < 8; ++i) {
    const auto found = level.numbers.find(voxel_key(low + VoxelIndex(i & 1, i >> 1 & 1, i >> 2)));
    if (found == level.numbers.end()) continue;
    const Cell& cell = level.cells[found->second];
    const Vector3f from = (at - centre_of(cell, level.cell_m)).cast<float>();
    for (std::uint32_t k = 0; k < cell.singles; ++k) {
      const Vector3d to = (cell.points[k] - from).cast<double>();
      if (to.squaredNorm() >= least) continue;
      least = to.squaredNorm();
      best = to;
    }
  }
  return best;
}

std::vector<Vector3f> PlaneMap::rough(const std::vector<Vector3f>& points) const {
  std::vector<Vector3f> found;
  const Eigen::Matrix3d turn = turn_of_cells();
  for (const Vector3f& point : points) {
    const Cell* cell = levels_[0].find(turn * point.cast<double>());
    if (cell != nullptr && cell->is_rough) found.push_back(point);
  }
  return found;
}

double PlaneMap::closeness(const std::vector<Vector3f>& points, const Pose& T_map_sensor,
                           double reach) const {
  double sum = 0.0;
  const Pose T_cells_sensor = turn_of_cells() * T_map_sensor;
  for (const Vector3f& point : points) {
    const auto to = to_nearest(T_cells_sensor * point.cast<double>(), reach);
    if (to) sum += 1.0 - to->norm() / reach;
  }
  return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

registration::Matches PlaneMap::match(const std::vector<Vector3f>& points, const Pose& T_map_sensor,
                                      double reach) const {
  registration::Matches matches;
  matches.reserve(points.size());
  int first = 0;
  while (first + 1 < kLevels && levels_[first].cell_m < reach) ++first;
  const Eigen::Matrix3d turn = turn_of_cells(), back = turn.transpose();
  const Pose T_cells_sensor = turn * T_map_sensor;
  for (const Vector3f& point : points) {
    const Vector3d at = T_cells_sensor * point.cast<double>();
    for (int k = first; k < kLevels; ++k) {
      const Cell* cell = levels_[k].find(at);
      if (cell == nullptr) continue;
      if (cell->is_rough) {
        if (k > 0) continue;
        const auto to = to_nearest(at, std::min(reach, 0.5 * cell_m_));
        for (int axis = 0; to && axis < 3; ++axis) {
          matches.push_back({back * at, back.col(axis), -(*to)[axis], kRoughWeight});
        }
        break;
      }
      const Vector3d normal = cell->normal.cast<double>();
      const double distance =
          normal.dot(at - centre_of(*cell, levels_[k].cell_m) - cell->mean.cast<double>());
      const Vector3d ray = (at - T_cells_sensor.translation()).normalized();
      const double weight = std::max<double>(cell->weight, std::pow(normal.dot(ray), 2));
      if (std::abs(distance) <= reach)
        matches.push_back({back * at, back * normal, distance, weight});
      break;
    }
  }
  return matches;
}

}  // namespace raymoval::odometry
