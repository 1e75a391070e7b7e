// SPDX-License-Identifier: MIT
#include "methods/freedom/maps.h"

#include <algorithm>
#include <bit>

namespace raymoval::freedom_method {
namespace {

constexpr int kSideBits = 3;
constexpr int kSide = 1 << kSideBits;

VoxelIndex block_of(const VoxelIndex& voxel) {
  return {voxel.x() >> kSideBits, voxel.y() >> kSideBits, voxel.z() >> kSideBits};
}

/// The place of a voxel in its block: its word, and its bit in it.
struct Place {
  std::size_t word, bit;

  explicit Place(const VoxelIndex& voxel)
      : word(static_cast<std::size_t>(voxel.x() & (kSide - 1))),
        bit(static_cast<std::size_t>((voxel.y() & (kSide - 1)) * kSide +
                                     (voxel.z() & (kSide - 1)))) {}
  [[nodiscard]] std::size_t index() const { return word * 64 + bit; }
  [[nodiscard]] std::uint64_t mask() const { return std::uint64_t{1} << bit; }
};

bool any(const BlockBits& bits) {
  return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
}

void count_up(std::uint8_t& count) {
  if (count < 255) ++count;
}

/// Calls `visit(block, passed)` for each block of 8 x 8 x 8 voxels, with the voxels that rays pass
/// and the scan does not hit.
template <class Visit>
void for_each_passed_block(const scan_grid::ScanBlock& columns, Visit&& visit) {
  constexpr int kGroups = scan_grid::kSide / kSide, kLayers = scan_grid::kHeight / kSide;
  const VoxelIndex first = columns.at.cwiseProduct(VoxelIndex(kGroups, kGroups, kLayers));
  for (int group = 0; group < kGroups * kGroups; ++group) {
    const int group_x = group / kGroups, group_y = group % kGroups;
    std::array<std::uint64_t, 64> passed;
    std::uint64_t all = 0;
    for (int i = 0; i < 64; ++i) {
      const auto& column = columns.columns[static_cast<std::size_t>(
          (group_x * kSide + i / kSide) * scan_grid::kSide + group_y * kSide + i % kSide)];
      all |= passed[static_cast<std::size_t>(i)] = column.free & ~column.hit;
    }
    for (int layer = 0; layer < kLayers; ++layer) {
      if ((all >> layer * kSide & 0xFF) == 0) continue;
      BlockBits bits{};
      for (std::size_t i = 0; i < 64; ++i) {
        bits[i / kSide] |= (passed[i] >> layer * kSide & 0xFF) << i % kSide * kSide;
      }
      visit(first + VoxelIndex(group_x, group_y, layer), bits);
    }
  }
}

constexpr double kAlmost = 1e-6;  ///< Voxels; far above the rounding of the walk.

/// The rays of one scan.
class Rays {
 public:
  Rays(const Eigen::Vector3d& sensor, const Parameters& parameters, scan_grid::ScanGrid& grid)
      : p_(parameters),
        scale_(1.0 / parameters.voxel_size()),
        sensor_(sensor * scale_),
        sensor_voxel_(voxel_index(sensor_, 1.0)),
        walk_(sensor_, grid) {}

  /// @param end relative to the sensor, along the world's axes, metres
  void cast(const Eigen::Vector3d& end) {
    const double length = end.norm();
    if (length == 0.0) return;
    const Eigen::Vector3d cut = end * (share_within_reach(end, length) * scale_);
    const Eigen::Vector3d direction = end / length;
    const double entry = entry_of(voxel_index(sensor_ + cut, 1.0), direction);
    if (entry >= 0.0) walk_.mark_free(direction, std::max(0.0, entry - kAlmost));
  }

 private:
  /// The share of a ray within the range and height limits of rays.
  [[nodiscard]] double share_within_reach(const Eigen::Vector3d& end, double length) const {
    double share = std::min(1.0, p_.ray_range / length);
    if (end.z() > p_.ray_highest) share = std::min(share, p_.ray_highest / end.z());
    if (end.z() < p_.ray_lowest) share = std::min(share, p_.ray_lowest / end.z());
    return share;
  }
  /// Distance at which a ray enters its last voxel; negative if this is the sensor's voxel.
  [[nodiscard]] double entry_of(const VoxelIndex& last, const Eigen::Vector3d& direction) const {
    double entry = -1.0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (last[k] == sensor_voxel_[k]) continue;
      const int wall = last[k] > sensor_voxel_[k] ? last[k] : last[k] + 1;
      entry = std::max(entry, (wall - sensor_[k]) / direction[k]);
    }
    return entry;
  }

  const Parameters& p_;
  double scale_;
  Eigen::Vector3d sensor_;  ///< In voxels.
  VoxelIndex sensor_voxel_;
  scan_grid::FreeWalk walk_;
};

}  // namespace

void cast_rays(const Scan& scan, const ScanMap& voxels,
               const std::vector<Eigen::Vector3d>& hole_ends, const Parameters& parameters,
               scan_grid::ScanGrid& grid, const RunContext& context) {
  constexpr std::size_t kRaysInTurn = 4096;  // Between two checks for a cancel.
  for (const ScanVoxel& voxel : voxels.voxels()) {
    grid.column(voxel.at).hit |= scan_grid::bit_of(voxel.at);
  }
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  Rays rays(sensor, parameters, grid);
  std::size_t count = 0;
  for (const ScanVoxel& voxel : voxels.voxels()) {
    if (++count % kRaysInTurn == 0) context.check_cancelled();
    rays.cast(voxel.mean() * parameters.voxel_size() - sensor);
  }
  for (const Eigen::Vector3d& end : hole_ends) {
    if (++count % kRaysInTurn == 0) context.check_cancelled();
    rays.cast(scan.T_world_sensor.linear() * end);
  }
}

bool FreeMap::is_free(const VoxelIndex& voxel) const {
  const FreeBlock* block = blocks_.find(block_of(voxel));
  const Place place(voxel);
  return block != nullptr && (block->is_free[place.word] & place.mask()) != 0;
}

void FreeMap::count_hits(ScanMap& scan) {
  std::vector<VoxelIndex> reverted;
  for (ScanVoxel& voxel : scan.voxels()) {
    FreeBlock* block = blocks_.find(block_of(voxel.at));
    if (block == nullptr) continue;
    const Place place(voxel.at);
    block->passes[place.index()] = 0;
    block->is_ready[place.word] &= ~place.mask();
    count_up(block->hits[place.index()]);
    if ((block->is_free[place.word] & place.mask()) != 0) voxel.level = Level::kConservative;
    if (block->hits[place.index()] >= p_.counts_to_revert) reverted.push_back(voxel.at);
  }
  // After all are classified, so that their order has no effect.
  for (const VoxelIndex& voxel : reverted) {
    for_each_around(voxel, 1, [this](const VoxelIndex& at) { revert(at); });
  }
}

void FreeMap::revert(const VoxelIndex& voxel) {
  FreeBlock* block = blocks_.find(block_of(voxel));
  const Place place(voxel);
  if (block == nullptr || (block->is_free[place.word] & place.mask()) == 0) return;
  block->is_free[place.word] &= ~place.mask();
}

void FreeMap::pass(const VoxelIndex& index, const BlockBits& passed,
                   std::vector<Candidates>& candidates) {
  FreeBlock& block = blocks_.find_or_make(index);
  const auto is_full = [](std::uint64_t word) { return word == ~std::uint64_t{0}; };
  if (std::all_of(block.is_free.begin(), block.is_free.end(), is_full)) return;
  Candidates found{index, {}};
  for (std::size_t word = 0; word < passed.size(); ++word) {
    for (std::uint64_t left = passed[word]; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(left));
      std::uint8_t& passes = block.passes[word * 64 + bit];
      count_up(passes);
      block.hits[word * 64 + bit] = 0;
      if (passes >= p_.counts_to_free) block.is_ready[word] |= std::uint64_t{1} << bit;
    }
    found.voxels[word] = passed[word] & block.is_ready[word] & ~block.is_free[word];
  }
  if (any(found.voxels)) candidates.push_back(found);
}

BlockBits FreeMap::all_neighbours_ready(const VoxelIndex& index) const {
  constexpr int kWide = kSide + 2;  // With one voxel of the neighbours on either side.
  std::array<std::array<std::array<const FreeBlock*, 3>, 3>, 3> around;
  for_each_around(VoxelIndex::Zero(), 1, [&](const VoxelIndex& step) {
    const Eigen::Matrix<std::size_t, 3, 1> place = (step.array() + 1).cast<std::size_t>();
    around[place.x()][place.y()][place.z()] = blocks_.find(index + step);
  });
  // The column at (x, y), with the voxels whose neighbours below and above are ready too.
  const auto eroded_column = [&](std::size_t x, std::size_t y) -> std::uint64_t {
    const auto& blocks = around[(x + kSide - 1) / kSide][(y + kSide - 1) / kSide];
    const auto bits_of = [&](std::size_t layer) -> std::uint64_t {
      if (blocks[layer] == nullptr) return 0;
      const std::uint64_t word = blocks[layer]->is_ready[(x + kSide - 1) % kSide];
      return word >> (y + kSide - 1) % kSide * kSide & 0xFF;
    };
    const std::uint64_t column = bits_of(0) >> 7 | bits_of(1) << 1 | bits_of(2) << 9;
    return column & column >> 1 & column >> 2 & 0xFF;
  };
  std::array<std::array<std::uint64_t, kWide>, kWide> columns;
  for (std::size_t x = 0; x < kWide; ++x) {
    for (std::size_t y = 0; y < kWide; ++y) columns[x][y] = eroded_column(x, y);
  }
  BlockBits ready{};
  for (std::size_t x = 0; x < kSide; ++x) {
    for (std::size_t y = 0; y < kSide; ++y) {
      std::uint64_t column = 0xFF;
      for (std::size_t i = 0; i < 9; ++i) column &= columns[x + i / 3][y + i % 3];
      ready[x] |= column << y * kSide;
    }
  }
  return ready;
}

std::vector<VoxelIndex> FreeMap::count_passes(const scan_grid::ScanGrid& rays) {
  std::vector<Candidates> candidates;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for_each_passed_block(rays[i], [&](const VoxelIndex& block, const BlockBits& passed) {
      pass(block, passed, candidates);
    });
  }
  // After all are counted, so that their order has no effect.
  std::vector<VoxelIndex> newly_free;
  for (const Candidates& found : candidates) {
    const BlockBits ready = all_neighbours_ready(found.block);
    FreeBlock& block = *blocks_.find(found.block);
    for (std::size_t word = 0; word < ready.size(); ++word) {
      const std::uint64_t free = found.voxels[word] & ready[word];
      block.is_free[word] |= free;
      for (std::uint64_t left = free; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        newly_free.push_back(found.block * kSide +
                             VoxelIndex(static_cast<int>(word), bit / kSide, bit % kSide));
      }
    }
  }
  return newly_free;
}

}  // namespace raymoval::freedom_method
