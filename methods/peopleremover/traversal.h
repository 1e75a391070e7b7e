// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "methods/peopleremover/bricks.h"

namespace raymoval::peopleremover_method {

/// Freed voxels, one word per brick of a map. Bits are only ever set while beams are followed, from
/// any thread, so that the order of the scans cannot show.
class FreedVoxels {
 public:
  explicit FreedVoxels(std::size_t bricks) : words_(bricks, 0) {}
  [[nodiscard]] BrickWord load(BrickId brick) {
    return std::atomic_ref(words_[brick]).load(std::memory_order_relaxed);
  }
  void set(BrickId brick, BrickWord voxels) {
    std::atomic_ref(words_[brick]).fetch_or(voxels, std::memory_order_relaxed);
  }
  /// Only once no thread sets any more.
  [[nodiscard]] std::vector<BrickWord>& words() { return words_; }

 private:
  std::vector<BrickWord> words_;
};

/// Voxels that belong to one scan (or a few), as words beside those of a map. Clearing takes time
/// by what was set only.
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
/// crossing time is (wall - start) / direction, never a running sum, so that bricks of voxels can
/// be stepped over and the same voxels are found as by single steps.
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
