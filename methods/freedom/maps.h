// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/scan/cell_set.h"
#include "core/scan/scan.h"
#include "core/scan/voxel_numbers.h"
#include "methods/common/scan_grid.h"
#include "methods/common/sparse_blocks.h"
#include "methods/freedom/freedom.h"
#include "methods/remover.h"

namespace raymoval::freedom_method {

/// The certainty that a point is dynamic. A point replaces points of a higher level.
enum class Level : std::uint8_t {
  kStatic,
  kAggressive,    ///< Near a moderate point.
  kModerate,      ///< Beside a conservative point.
  kConservative,  ///< In free space.
  kEmpty,         ///< The point was removed.
};

/// The voxel that a sub-voxel lies in.
inline VoxelIndex voxel_of(const VoxelIndex& sub_voxel) {
  return {sub_voxel.x() >> 2, sub_voxel.y() >> 2, sub_voxel.z() >> 2};
}
/// The place of a sub-voxel in its voxel, 0 to 63, and back.
inline int place_of(const VoxelIndex& sub_voxel) {
  return (sub_voxel.x() & 3) << 4 | (sub_voxel.y() & 3) << 2 | (sub_voxel.z() & 3);
}
inline VoxelIndex sub_voxel_at(const VoxelIndex& voxel, int place) {
  return 4 * voxel + VoxelIndex(place >> 4, place >> 2 & 3, place & 3);
}

/// A voxel in which a scan has points.
struct ScanVoxel {
  VoxelIndex at = VoxelIndex::Zero();
  Level level = Level::kStatic;
  std::uint64_t sub_voxels = 0;  ///< The sub-voxels with a point, one bit each.
  /// Sum of the points' positions in the voxel, in units of 2^-24 voxel, so that it does not depend
  /// on their order.
  Eigen::Matrix<std::int64_t, 3, 1> sum = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
  std::int64_t points = 0;

  void add(const Eigen::Vector3d& in_voxels, int place) {
    // Adds half a unit and truncates: `std::round` takes as long as all other work.
    sum += (((in_voxels - at.cast<double>()) * kUnit).array() + 0.5).cast<std::int64_t>().matrix();
    sub_voxels |= std::uint64_t{1} << place;
    ++points;
  }
  /// The mean of the points, in voxels.
  [[nodiscard]] Eigen::Vector3d mean() const {
    return at.cast<double>() + sum.cast<double>() / (kUnit * static_cast<double>(points));
  }

 private:
  static constexpr double kUnit = 1 << 24;
};

/// Step 1: the voxels of a scan.
class ScanMap {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Replaces the content; the memory is used again.
  void fill(const Scan& scan, const Parameters& parameters);

  [[nodiscard]] std::vector<ScanVoxel>& voxels() { return voxels_; }
  [[nodiscard]] const std::vector<ScanVoxel>& voxels() const { return voxels_; }
  /// The number of a voxel in `voxels()`; `kNone` if it has no point.
  [[nodiscard]] std::uint32_t find(const VoxelIndex& voxel) const {
    const auto found = numbers_.find(voxel_key(voxel));
    return found == numbers_.end() ? kNone : found->second;
  }
  /// Second part of step 2: grows levels from the conservative voxels.
  void grow();

 private:
  std::vector<ScanVoxel> voxels_;
  VoxelMap<std::uint32_t> numbers_;
};

/// One bit for each voxel of a block of 8 x 8 x 8: word x, byte y, bit z.
using BlockBits = std::array<std::uint64_t, 8>;

/// Numbers of passes and hits of the voxels of a block, 1.2 KiB.
struct FreeBlock {
  std::array<std::uint8_t, 512> passes{};  ///< Scans that passed since the last hit.
  std::array<std::uint8_t, 512> hits{};    ///< Scans that hit since the last pass.
  BlockBits is_ready{};                    ///< Passed often enough to be free.
  BlockBits is_free{};
};

/// First part of step 4: marks in `grid` (empty before) the voxels of a scan as hit, and the voxels
/// on the rays to the voxels' mean points and to `hole_ends` as free. A ray stops before a voxel
/// that the scan hits, and before the voxel that it ends in.
/// @param hole_ends ends of rays without a return, sensor frame, metres
/// @param context is checked for a cancel now and then
/// @throws DataError for rays that cross too many voxels; Cancelled
/// @note a voxel that a ray crosses for less than a millionth of a voxel just before its last voxel
/// is not marked
void cast_rays(const Scan& scan, const ScanMap& voxels,
               const std::vector<Eigen::Vector3d>& hole_ends, const Parameters& parameters,
               scan_grid::ScanGrid& grid, const RunContext& context = {});

/// Free space from all scans so far. Counts stop at 255, the largest threshold.
class FreeMap {
 public:
  explicit FreeMap(const Parameters& parameters) : p_(parameters) {}

  /// First part of step 2: counts the voxels of a scan as hit. Hit voxels that are free become
  /// conservative. Voxels that are hit too often, and their neighbours, are no longer free.
  void count_hits(ScanMap& scan);
  /// Second part of step 4: counts the voxels that rays of a scan pass. @return the newly free ones
  [[nodiscard]] std::vector<VoxelIndex> count_passes(const scan_grid::ScanGrid& rays);

  [[nodiscard]] bool is_free(const VoxelIndex& voxel) const;

 private:
  /// Voxels of a block that may become free.
  struct Candidates {
    VoxelIndex block;
    BlockBits voxels;
  };

  void revert(const VoxelIndex& voxel);
  void pass(const VoxelIndex& block, const BlockBits& passed, std::vector<Candidates>& candidates);
  [[nodiscard]] BlockBits all_neighbours_ready(const VoxelIndex& block) const;

  Parameters p_;
  SparseBlocks<FreeBlock> blocks_;
};

/// The state of a sub-voxel: the scan and the level of its point.
struct SubVoxel {
  static constexpr std::uint32_t kMostScans = 1U << 29;

  std::uint32_t scan : 29 = 0;
  std::uint32_t level : 3 = static_cast<std::uint32_t>(Level::kEmpty);

  [[nodiscard]] bool holds(std::size_t of_scan) const {
    return scan == of_scan && !is(Level::kEmpty);
  }
  void set(std::size_t of_scan, Level of_level) {
    scan = static_cast<std::uint32_t>(of_scan) & (kMostScans - 1);
    level = static_cast<std::uint32_t>(of_level) & 7;
  }
  [[nodiscard]] bool is(Level of_level) const {
    return level == static_cast<std::uint32_t>(of_level);
  }
};

/// The sub-voxels of a voxel that ever had a point. They are packed in the order of their places.
class SubVoxels {
 public:
  /// The sub-voxel at a place; an empty one is made if there is none.
  SubVoxel& at(int place);
  [[nodiscard]] std::span<SubVoxel> all() { return {cells_.get(), count()}; }
  [[nodiscard]] std::span<const SubVoxel> all() const { return {cells_.get(), count()}; }
  /// The places of `all`, one bit each.
  [[nodiscard]] std::uint64_t places() const { return places_; }
  [[nodiscard]] bool holds(std::size_t scan) const;

 private:
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::popcount(places_));
  }

  std::uint64_t places_ = 0;
  std::unique_ptr<SubVoxel[]> cells_;  ///< Room for `room_for(count())`.
};

/// The points of all scans so far, one in a sub-voxel, without their coordinates. It takes about 40
/// bytes per voxel and 6 per sub-voxel.
class StaticMap {
 public:
  /// Step 5: raises levels in and around newly free voxels, scan by scan.
  void remove(const std::vector<VoxelIndex>& newly_free);
  /// Step 6: integrates the points of scan number `scan`.
  void integrate(const ScanMap& voxels, std::size_t scan);
  /// Step 7: the sub-voxels that had points and have no static one.
  [[nodiscard]] CellSet removed() const;

  /// The level of a sub-voxel; kEmpty also where there never was a point.
  [[nodiscard]] Level level_of(const VoxelIndex& sub_voxel) const;
  [[nodiscard]] std::size_t size() const { return voxels_.size(); }

 private:
  using Number = VoxelNumbers::Number;
  /// The points of one scan in a voxel.
  struct Seed {
    std::uint32_t scan;
    Number voxel;
    friend auto operator<=>(const Seed&, const Seed&) = default;
  };

  [[nodiscard]] auto key_of() const {
    return [this](Number number) { return keys_[number]; };
  }
  [[nodiscard]] Number find(const VoxelIndex& voxel) const {
    return numbers_.find(voxel_key(voxel), key_of());
  }
  [[nodiscard]] std::vector<Seed> seeds_in(const std::vector<VoxelIndex>& newly_free) const;
  void raise(Number voxel, std::uint32_t scan, Level level);
  void grow(std::span<const Seed> seeds);
  void clear_without_static();

  VoxelNumbers numbers_;
  std::vector<VoxelKey> keys_;
  std::vector<SubVoxels> voxels_;
  // Of the current step 5.
  std::vector<std::uint32_t> reached_;  ///< By voxel: the last growth that reached it.
  std::uint32_t growths_ = 0;
  std::vector<Number> touched_;
};

}  // namespace raymoval::freedom_method
