// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

#include "methods/peopleremover/bricks.h"
#include "methods/peopleremover/peopleremover.h"

namespace raymoval::peopleremover_method {

/// Points of a scan sorted by direction into rows of equal height (sine of the elevation) and
/// columns of about equal azimuth. Positions below are in that order: by row, then column, then
/// number in the scan.
class DirectionIndex {
 public:
  static constexpr int kRows = 256;
  static constexpr int kColumns = 720;

  /// Sorts `points` (sensor frame, metres, none at the origin). Reuses its memory.
  void build(const std::vector<Eigen::Vector3d>& points);

  [[nodiscard]] std::size_t size() const { return point.size(); }

  /// Calls `visit(begin, end)` with ranges of positions. They contain all points whose direction is
  /// within an angle of that at `position`, and some others.
  /// @param half_sine sine of half that angle, in (0, 1)
  template <class Visit>
  void for_each_range_near(std::size_t position, double half_sine, Visit&& visit) const {
    const Window window = window_around(direction[position], half_sine);
    for (int row = window.first_row; row <= window.last_row; ++row) {
      const auto start = static_cast<std::size_t>(row * kColumns);
      const auto span = [&](int first, int last) {
        visit(cell_start_[start + static_cast<std::size_t>(first)],
              cell_start_[start + static_cast<std::size_t>(last) + 1]);
      };
      if (window.last_column < kColumns) {
        span(window.first_column, window.last_column);
      } else {
        span(0, window.last_column - kColumns);
        span(window.first_column, kColumns - 1);
      }
    }
  }

  std::vector<std::uint32_t> number;       ///< The number of each point in the scan.
  std::vector<double> range;               ///< r, metres.
  std::vector<Eigen::Vector3d> direction;  ///< u = p / r.
  std::vector<Eigen::Vector3d> point;      ///< p, metres.

 private:
  /// `last_column` is below `first_column + kColumns` and may pass the end once.
  struct Window {
    int first_row, last_row, first_column, last_column;
  };
  [[nodiscard]] static Window window_around(const Eigen::Vector3d& direction, double half_sine);

  std::vector<std::uint32_t> cell_start_;
  std::vector<std::uint32_t> cell_of_;
  std::vector<double> range_of_;
};

inline constexpr double kWholeBeam = std::numeric_limits<double>::infinity();

/// Finds the length to which each beam of a scan is followed (step 2.3, "point shadows"). Each
/// thread needs its own object; it keeps its memory from scan to scan.
class BeamEnds {
 public:
  explicit BeamEnds(const Parameters& parameters) : parameters_(parameters) {}

  /// @param points of one scan, sensor frame, metres, none at the origin
  /// @return metres from the sensor along each beam; `kWholeBeam` for the whole beam
  const std::vector<double>& find(const std::vector<Eigen::Vector3d>& points);

 private:
  void sort_by_range();
  void cast_shadow_of(std::size_t owner);
  void find_neighbours(std::size_t owner, double half_sine);
  /// Unit normal of the surface through the neighbours, towards the sensor.
  [[nodiscard]] Eigen::Vector3d normal_at(std::size_t owner) const;

  const Parameters& parameters_;
  DirectionIndex index_;
  std::vector<std::uint32_t> by_range_;  ///< Positions in the index, nearest first.
  std::vector<std::uint32_t> bucket_, start_;
  std::vector<std::uint32_t> neighbours_;  ///< Positions in the index.
  std::vector<double> length_;             ///< Metres, by position in the index.
  std::vector<double> answer_;             ///< Metres, by point.
};

/// The unit eigenvector of the smallest eigenvalue. It is zero if the points of the covariance lie
/// on a line (second eigenvalue below 1e-9 of the largest).
Eigen::Vector3d surface_normal(const Eigen::Matrix3d& covariance);

/// Freed voxels, one word per brick of a map. While beams are followed, bits are only set, from any
/// thread, so that the order of the scans has no effect.
class FreedVoxels {
 public:
  explicit FreedVoxels(std::size_t bricks) : words_(bricks, 0) {}
  [[nodiscard]] BrickWord load(BrickId brick) {
    return std::atomic_ref(words_[brick]).load(std::memory_order_relaxed);
  }
  void set(BrickId brick, BrickWord voxels) {
    std::atomic_ref(words_[brick]).fetch_or(voxels, std::memory_order_relaxed);
  }
  /// Only after the last thread has set bits.
  [[nodiscard]] std::vector<BrickWord>& words() { return words_; }

 private:
  std::vector<BrickWord> words_;
};

/// Voxels of one scan (or a few), as words parallel to those of a map. The time of clearing depends
/// only on the set voxels.
class VoxelMarks {
 public:
  explicit VoxelMarks(std::size_t bricks) : words_(bricks, 0) {}
  [[nodiscard]] BrickWord at(BrickId brick) const { return words_[brick]; }
  [[nodiscard]] const std::vector<BrickId>& bricks() const { return set_; }
  void set(BrickId brick, BrickWord voxels) {
    if (words_[brick] == 0) set_.push_back(brick);
    words_[brick] |= voxels;
  }
  void clear() {
    for (const BrickId brick : set_) words_[brick] = 0;
    set_.clear();
  }

 private:
  std::vector<BrickWord> words_;
  std::vector<BrickId> set_;
};

/// Follows beams from the sensor outwards (steps 2.5 and 2.6): frees the occupied voxels on the way
/// up to the first that holds a point of the beam's own window of scans.
///
/// The voxels visited are those of Amanatides and Woo (1987): the walls between the voxels of both
/// ends, crossed in order of (crossing time, axis), one at a time, the last voxel included. A
/// crossing time is (wall - start) / direction, never a running sum, so that skipping bricks gives
/// the same voxels as single steps.
class BeamWalker {
 public:
  BeamWalker(const BrickMap& map, FreedVoxels& freed, const VoxelMarks& own);
  /// @param from, to ends of the beam, voxel units
  void walk(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

 private:
  struct Beam;
  struct Entry;
  void visit_first(const VoxelIndex& voxel);
  bool walk_brick(const Beam& beam, const Entry& entry, BrickId brick);

  const BrickMap& map_;
  FreedVoxels& freed_;
  const VoxelMarks& own_;
  BrickFinder finder_;
};

}  // namespace raymoval::peopleremover_method
