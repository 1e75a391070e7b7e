// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace raymoval::raymoval_plus_method {
namespace {

/// A point's offset in its voxel is counted in 1/256 of the edge, 0.8 mm at 0.2 m: finer than
/// ranges are measured. Whole numbers give the same sum in any order.
constexpr double kParts = 256.0;
/// With more points a sum of offsets could exceed 32 bits. The mean has long settled by then.
constexpr std::int32_t kMostPoints = 1U << 16;
/// Added to the deviation of a voxel's points, metres: the noise of ranges and poses.
constexpr double kLeastDeviation = 0.04;
/// The points of a voxel are on a plane if their deviation along its normal is so much less than
/// along the next axis. A beam that passes it ends so far behind the plane, beside that deviation.
constexpr double kFlat = 0.7, kBehind = 0.1;
/// So many blocks are compared at a time with what they were.
constexpr std::uint32_t kComparedBlocks = 256;

}  // namespace

void EvidenceMap::add_point(std::uint32_t voxel, std::uint32_t parts) {
  add_sample(voxel, static_cast<int>(parts & 0xFFU), static_cast<int>(parts >> 8U & 0xFFU),
             static_cast<int>(upward(parts)));
}

void EvidenceMap::add_beside(std::uint32_t voxel, std::uint32_t parts,
                             const Eigen::Vector3f& offset) {
  const Eigen::Vector3f step = offset * static_cast<float>(kParts * inverse_);
  add_sample(voxel, static_cast<int>(parts & 0xFFU) + static_cast<int>(std::lround(step.x())),
             static_cast<int>(parts >> 8U & 0xFFU) + static_cast<int>(std::lround(step.y())),
             static_cast<int>(upward(parts)) + static_cast<int>(std::lround(step.z())));
}

void EvidenceMap::add_sample(std::uint32_t voxel, int x, int y, int z) {
  if (mean_changed_[voxel] == 0) {
    mean_changed_[voxel] = 1;
    changed_.push_back(voxel);
  }
  Sums& sums = sums_[voxel];
  if (sums.count == kMostPoints) return;
  sums.x += x;
  sums.y += y;
  sums.z += z;
  sums.xx += x * x;
  sums.yy += y * y;
  sums.zz += z * z;
  sums.xy += x * y;
  sums.xz += x * z;
  sums.yz += y * z;
  ++sums.count;
}

std::uint32_t EvidenceMap::add_voxel(const VoxelIndex& index, std::uint32_t slot) {
  occupied_.resize(blocks_.block_count(), 0);
  occupied_[slot / Blocks::kCells] |= std::uint64_t{1} << slot % Blocks::kCells;
  dynamic_.resize(blocks_.block_count(), 0);
  is_dynamic_.resize(blocks_.block_count(), 0);
  decisions_.resize(blocks_.block_count() * Blocks::kCells, Verdict::kUndecided);
  verdicts_.resize(decisions_.size(), Verdict::kUndecided);
  const VoxelIndex at(index.x() >> kTileShift, index.y() >> kTileShift, 0);
  const auto [found, fresh] =
      tile_numbers_.emplace(voxel_key(at), static_cast<std::uint32_t>(tiles_.size()));
  if (fresh) {
    const double side = (1 << kTileShift) * size_;
    // The height of the tile's first voxel keeps the offsets of all others small.
    tiles_.push_back({{at.x() * side, at.y() * side, index.z() * size_}, {}, {}, {}});
  }
  Tile& tile = tiles_[found->second];
  const auto number = static_cast<std::uint32_t>(voxels_.size());
  voxels_.push_back({index, slot, found->second, static_cast<std::uint32_t>(tile.voxels.size())});
  sums_.emplace_back();
  mean_changed_.push_back(0);
  tile.voxels.push_back(number);
  tile.places.resize(tile.places.size() + 3);
  tile.shapes.emplace_back();
  evidence_.emplace_back();
  return number;
}

void EvidenceMap::update_means() {
  for (const std::uint32_t number : changed_) {
    mean_changed_[number] = 0;
    const Voxel& voxel = voxels_[number];
    Tile& tile = tiles_[voxel.tile];
    const Eigen::Vector3f offset = (centroid(number) - tile.origin).cast<float>();
    std::copy_n(offset.data(), 3, tile.places.begin() + 3 * std::ptrdiff_t{voxel.place});
    tile.shapes[voxel.place] = shape(number);
  }
  changed_.clear();
}

Eigen::Vector3d EvidenceMap::centroid(std::size_t voxel) const {
  const Sums& sums = sums_[voxel];
  const double scale = 1.0 / (kParts * sums.count), half = 0.5 / kParts;
  const Eigen::Vector3d offset(sums.x * scale + half, sums.y * scale + half, sums.z * scale + half);
  return (index(voxel).cast<double>() + offset) * size_;
}

VoxelShape EvidenceMap::shape(std::size_t voxel) const {
  const Sums& sums = sums_[voxel];
  const double n = 1.0 / sums.count, scale = size_ / kParts;
  const Eigen::Vector3d mean = Eigen::Vector3d(sums.x, sums.y, sums.z) * n;
  Eigen::Matrix3d covariance;
  const auto d = [](std::int64_t sum) { return static_cast<double>(sum); };
  covariance << d(sums.xx), d(sums.xy), d(sums.xz), d(sums.xy), d(sums.yy), d(sums.yz), d(sums.xz),
      d(sums.yz), d(sums.zz);
  covariance = (covariance * n - mean * mean.transpose()) * (scale * scale);
  covariance.diagonal().array() += kLeastDeviation * kLeastDeviation;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance);
  const Eigen::Vector3d deviations = axes.eigenvalues().cwiseMax(1e-6).cwiseSqrt();
  const bool is_flat = knows_planes_ && deviations[0] < kFlat * deviations[1];
  const Eigen::Vector3f normal = axes.eigenvectors().col(0).cast<float>();
  const float behind = is_flat ? static_cast<float>(kBehind + deviations[0]) : 0.0F;
  const Eigen::Matrix3f inverse = covariance.inverse().cast<float>();
  return {inverse(0, 0), inverse(1, 1), inverse(2, 2), inverse(0, 1),
          inverse(0, 2), inverse(1, 2), sums.nearest,  normal.x(),
          normal.y(),    normal.z(),    behind,        static_cast<float>(deviations[2])};
}

double EvidenceMap::above_mean(std::size_t voxel, std::uint32_t parts) const {
  const Sums& sums = sums_[voxel];
  return (upward(parts) - static_cast<double>(sums.z) / sums.count) * (size_ / kParts);
}

VoxelIndex EvidenceMap::tile_at(const Eigen::Vector3d& place) const {
  const double side = (1 << kTileShift) * size_;
  return {static_cast<int>(std::floor(place.x() / side)),
          static_cast<int>(std::floor(place.y() / side)), 0};
}

std::vector<std::uint32_t> EvidenceMap::tiles_near(const Eigen::Vector3d& center,
                                                   double range) const {
  const double side = (1 << kTileShift) * size_;
  const int reach = static_cast<int>(std::ceil(range / side));
  const VoxelIndex middle = tile_at(center);
  std::vector<std::uint32_t> near;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      // The corners of this square of tiles are farther away, by whole tiles less one at each end.
      const double apart_x = std::max(std::abs(x) - 1, 0), apart_y = std::max(std::abs(y) - 1, 0);
      if (std::hypot(apart_x, apart_y) * side > range + size_) continue;
      const auto found = tile_numbers_.find(voxel_key(middle + VoxelIndex(x, y, 0)));
      if (found != tile_numbers_.end()) near.push_back(found->second);
    }
  }
  std::sort(near.begin(), near.end());
  return near;
}

void EvidenceMap::set_decision(std::size_t voxel, Verdict decision) {
  Verdict& now = decisions_[slot(voxel)];
  if (now == decision) return;
  std::uint8_t& dynamic = dynamic_[block_of(voxel)];
  if (now == Verdict::kDynamic) --dynamic;
  if (decision == Verdict::kDynamic) ++dynamic;
  is_dynamic_[block_of(voxel)] = dynamic > 0 ? 1 : 0;
  now = decision;
}

void EvidenceMap::update_surroundings(int reach) {
  if (reach != std::exchange(reach_, reach)) {
    was_dynamic_.clear();
    dynamic_around_.clear();
  }
  const auto known = static_cast<std::uint32_t>(was_dynamic_.size());
  const auto blocks = static_cast<std::uint32_t>(blocks_.block_count());
  was_dynamic_.resize(blocks, 0);
  dynamic_around_.resize(blocks, 0);
  for (std::uint32_t block = known == 0 ? blocks : known; block < blocks; ++block) {
    blocks_.for_blocks_around(block, reach, [&](std::uint32_t other) {
      dynamic_around_[block] =
          static_cast<std::uint16_t>(dynamic_around_[block] + was_dynamic_[other]);
    });
  }
  // Few blocks change, so that most are compared many at a time.
  for (std::uint32_t first = 0; first < blocks; first += kComparedBlocks) {
    const std::uint32_t end = std::min(blocks, first + kComparedBlocks);
    if (std::equal(is_dynamic_.begin() + first, is_dynamic_.begin() + end,
                   was_dynamic_.begin() + first)) {
      continue;
    }
    for (std::uint32_t block = first; block < end; ++block) {
      const int more = is_dynamic_[block] - was_dynamic_[block];
      if (more == 0) continue;
      was_dynamic_[block] = is_dynamic_[block];
      blocks_.for_blocks_around(block, reach, [&](std::uint32_t other) {
        dynamic_around_[other] = static_cast<std::uint16_t>(dynamic_around_[other] + more);
      });
    }
  }
}

void EvidenceMap::take_decisions(std::uint32_t block) {
  std::copy_n(decisions(block), Blocks::kCells,
              verdicts_.begin() + static_cast<std::ptrdiff_t>(block * Blocks::kCells));
}

}  // namespace raymoval::raymoval_plus_method
