// SPDX-License-Identifier: MIT
#include "methods/peopleremover/beams.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "methods/common/diamond_angle.h"

namespace raymoval::peopleremover_method {
namespace {

int row_of(double sine) {
  return std::clamp(static_cast<int>((sine + 1.0) * (DirectionIndex::kRows / 2.0)), 0,
                    DirectionIndex::kRows - 1);
}

int column_of(double x, double y) {
  return std::clamp(static_cast<int>(diamond_angle(x, y) * (DirectionIndex::kColumns / 4.0)), 0,
                    DirectionIndex::kColumns - 1);
}

}  // namespace

void DirectionIndex::build(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t count = points.size();
  cell_start_.assign(static_cast<std::size_t>(kRows * kColumns) + 1, 0);
  cell_of_.resize(count);
  range_of_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    range_of_[k] = points[k].norm();
    const int row = row_of(points[k].z() / range_of_[k]);
    cell_of_[k] =
        static_cast<std::uint32_t>(row * kColumns + column_of(points[k].x(), points[k].y()));
    ++cell_start_[cell_of_[k] + 1];
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  number.resize(count);
  range.resize(count);
  direction.resize(count);
  point.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = cell_start_[cell_of_[k]]++;
    number[at] = static_cast<std::uint32_t>(k);
    range[at] = range_of_[k];
    direction[at] = points[k] / range_of_[k];
    point[at] = points[k];
  }
  // Filling has moved every start to the start of the next cell.
  for (std::size_t c = cell_start_.size() - 1; c > 0; --c) cell_start_[c] = cell_start_[c - 1];
  cell_start_[0] = 0;
}

DirectionIndex::Window DirectionIndex::window_around(const Eigen::Vector3d& u, double half_sine) {
  // Much larger than rounding errors, much smaller than a cell.
  constexpr double kMargin = 2e-9;
  const double cosine = 1.0 - 2.0 * half_sine * half_sine - 0.5 * kMargin;
  const double sine = 2.0 * half_sine * std::sqrt(std::max(0.0, 1.0 - half_sine * half_sine));
  const double flat = std::sqrt(u.x() * u.x() + u.y() * u.y());
  const bool has_top = u.z() >= cosine, has_bottom = -u.z() >= cosine;
  Window window{};
  window.last_row = has_top ? kRows - 1 : row_of(u.z() * cosine + flat * sine + kMargin);
  window.first_row = has_bottom ? 0 : row_of(u.z() * cosine - flat * sine - kMargin);
  if (has_top || has_bottom || flat <= sine * (1.0 + kMargin)) {
    window.last_column = kColumns - 1;
    return window;
  }
  // Half width of the cap in azimuth: sin = sin(angle) / cos(elevation).
  const double s = std::min(1.0, sine / flat + kMargin);
  const double c = std::sqrt(1.0 - s * s);
  window.first_column = column_of(u.x() * c + u.y() * s, u.y() * c - u.x() * s);
  window.last_column = column_of(u.x() * c - u.y() * s, u.y() * c + u.x() * s);
  if (window.last_column < window.first_column) window.last_column += kColumns;
  return window;
}

const std::vector<double>& BeamEnds::find(const std::vector<Eigen::Vector3d>& points) {
  answer_.assign(points.size(), kWholeBeam);
  if (parameters_.maxrange_method == MaxrangeMethod::kNone) return answer_;
  index_.build(points);
  length_.assign(points.size(), kWholeBeam);
  sort_by_range();
  for (const std::uint32_t owner : by_range_) {
    if (length_[owner] == kWholeBeam) cast_shadow_of(owner);
  }
  for (std::size_t k = 0; k < length_.size(); ++k) answer_[index_.number[k]] = length_[k];
  return answer_;
}

/// Sorts by (range, number in the scan): first into buckets by the leading bits of the range as a
/// single-precision number, then inside each bucket.
void BeamEnds::sort_by_range() {
  constexpr unsigned kDroppedBits = 12;
  const std::size_t count = index_.size();
  bucket_.resize(count);
  std::uint32_t lowest = ~0U, highest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    bucket_[k] = std::bit_cast<std::uint32_t>(static_cast<float>(index_.range[k])) >> kDroppedBits;
    lowest = std::min(lowest, bucket_[k]);
    highest = std::max(highest, bucket_[k]);
  }
  by_range_.resize(count);
  if (count == 0) return;
  start_.assign(highest - lowest + 2, 0);
  for (std::size_t k = 0; k < count; ++k) ++start_[bucket_[k] - lowest + 1];
  for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
  for (std::size_t k = 0; k < count; ++k) {
    by_range_[start_[bucket_[k] - lowest]++] = static_cast<std::uint32_t>(k);
  }
  std::uint32_t begin = 0;  // Filling has moved each start to the end of its bucket.
  for (std::size_t b = 0; b + 1 < start_.size(); ++b) {
    std::sort(by_range_.begin() + begin, by_range_.begin() + start_[b],
              [this](std::uint32_t i, std::uint32_t j) {
                return std::pair(index_.range[i], index_.number[i]) <
                       std::pair(index_.range[j], index_.number[j]);
              });
    begin = start_[b];
  }
}

/// Ends the beams around `owner` at the plane parallel to the surface there, one voxel diagonal in
/// front of it.
void BeamEnds::cast_shadow_of(std::size_t owner) {
  const double diagonal = parameters_.voxel_diagonal();
  const double range = index_.range[owner];
  if (range <= 2.0 * diagonal) {
    length_[owner] = 0.0;
    return;
  }
  // angle = 2 asin(diagonal / (range - diagonal))
  find_neighbours(owner, diagonal / (range - diagonal));
  const Eigen::Vector3d normal = normal_at(owner);
  const double plane = index_.point[owner].dot(normal) + diagonal;
  const double own_cosine = index_.direction[owner].dot(normal);
  if (own_cosine == 0.0) {
    length_[owner] = 0.0;
    return;
  }
  length_[owner] = std::clamp(plane / own_cosine, 0.0, range);
  for (const std::uint32_t k : neighbours_) {
    const double cosine = index_.direction[k].dot(normal);
    if (cosine == 0.0) continue;
    const double length = plane / cosine;
    if (length > index_.range[k]) continue;  // In front of the plane: not shortened here.
    length_[k] = std::min(length_[k], std::max(0.0, length));
  }
}

void BeamEnds::find_neighbours(std::size_t owner, double half_sine) {
  const double squared_chord = 4.0 * half_sine * half_sine;
  const Eigen::Vector3d direction = index_.direction[owner];
  neighbours_.clear();
  index_.for_each_range_near(owner, half_sine, [&](std::size_t begin, std::size_t end) {
    const std::size_t before = neighbours_.size();
    neighbours_.resize(before + (end - begin));
    std::uint32_t* next = neighbours_.data() + before;
    for (std::size_t k = begin; k < end; ++k) {
      *next = static_cast<std::uint32_t>(k);
      next += (index_.direction[k] - direction).squaredNorm() < squared_chord ? 1 : 0;
    }
    neighbours_.resize(static_cast<std::size_t>(next - neighbours_.data()));
  });
}

Eigen::Vector3d BeamEnds::normal_at(std::size_t owner) const {
  const Eigen::Vector3d backwards = -index_.direction[owner];
  if (neighbours_.size() < 3) return backwards;
  // Relative to the owner, which is among them: small numbers, one pass.
  const Eigen::Vector3d origin = index_.point[owner];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const std::uint32_t k : neighbours_) {
    const Eigen::Vector3d p = index_.point[k] - origin;
    sum += p;
    xx += p.x() * p.x();
    xy += p.x() * p.y();
    xz += p.x() * p.z();
    yy += p.y() * p.y();
    yz += p.y() * p.z();
    zz += p.z() * p.z();
  }
  Eigen::Matrix3d covariance;
  covariance << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const double count = static_cast<double>(neighbours_.size());
  covariance = (covariance - sum * sum.transpose() / count) / count;
  const Eigen::Vector3d normal = surface_normal(covariance);
  if (normal.isZero()) return backwards;
  return normal.dot(index_.direction[owner]) >= 0.0 ? Eigen::Vector3d(-normal) : normal;
}

Eigen::Vector3d surface_normal(const Eigen::Matrix3d& covariance) {
  const double scale = covariance.diagonal().maxCoeff();
  if (!(scale > 0.0)) return Eigen::Vector3d::Zero();
  const Eigen::Matrix3d scaled = covariance / scale;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scaled);
  // The closed form loses half of its digits if two eigenvalues are nearly equal.
  if (solver.eigenvalues()[1] < 1e-5 * solver.eigenvalues()[2] ||
      solver.eigenvalues()[1] - solver.eigenvalues()[0] < 1e-5 * solver.eigenvalues()[2]) {
    solver.compute(scaled);
  }
  if (solver.eigenvalues()[1] < 1e-9 * solver.eigenvalues()[2]) return Eigen::Vector3d::Zero();
  return solver.eigenvectors().col(0);
}

}  // namespace raymoval::peopleremover_method
