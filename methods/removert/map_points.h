// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"

namespace raymoval::removert_method {

/// Ball around points, so that a pass can skip them together.
struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< World frame, metres.
  float radius = 0.0F;
};

/// Map points in a cube of the world lattice.
struct Block {
  VoxelKey key = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< The cube's centre, world frame, metres.
  std::size_t begin = 0, end = 0;                    ///< Its points.
  Ball ball;
};

/// 8 x 8 x 8 cubes.
struct BlockGroup {
  std::size_t begin = 0, end = 0;  ///< Its blocks.
  Ball ball;
};

/// The map, as points relative to the centres of their blocks: 16 bytes per point. The order of the
/// points depends only on their positions in the world.
struct MapPoints {
  std::vector<Block> blocks;
  std::vector<BlockGroup> groups;
  std::vector<float> x, y, z;     ///< Metres from the block's centre.
  std::vector<std::uint32_t> id;  ///< Cell within the block.

  [[nodiscard]] std::size_t size() const { return id.size(); }
  [[nodiscard]] Eigen::Vector3d position(const Block& block, std::size_t i) const {
    return block.centre + Eigen::Vector3d(x[i], y[i], z[i]);
  }
  void reserve(std::size_t points);
  /// Finds balls and groups, after all blocks were added in order.
  void close();
};

/// The points with `marks[i] == mark`, in the order of the map.
MapPoints marked_points(const MapPoints& points, const Mask& marks, std::uint8_t mark);

/// Cells of the map: cubes of `voxel` metres of the world lattice, in blocks of about 0.8 m.
class CellLattice {
 public:
  explicit CellLattice(double voxel) : edge_(voxel), inverse_edge_(1.0 / voxel) {
    while (edge_ * (2 << bits_) <= kBlockEdge * 1.0001) ++bits_;
  }

  struct Place {
    VoxelKey block;
    std::uint32_t cell;  ///< The cell within the block.
    VoxelIndex index;    ///< The cell in the world lattice.
  };
  /// @throws DataError beyond the lattice
  [[nodiscard]] Place place_of(const Eigen::Vector3d& world) const;
  [[nodiscard]] VoxelIndex cell_index(VoxelKey block, std::uint32_t cell) const;
  [[nodiscard]] Eigen::Vector3d cell_centre(const VoxelIndex& index) const;
  [[nodiscard]] Eigen::Vector3d block_centre(VoxelKey block) const;
  [[nodiscard]] std::uint32_t cells_per_block() const { return 1U << (3 * bits_); }

 private:
  static constexpr double kBlockEdge = 0.8;  ///< Metres, at most (or one cell).
  double edge_, inverse_edge_;
  int bits_ = 0;  ///< A block has 2^bits cells along an edge.
};

/// Collects points into the map: one centroid per cell. An entry takes 20 bytes. At most half as
/// many entries as there are cells, plus 32 per block, are not merged yet.
class MapBuilder {
 public:
  explicit MapBuilder(const CellLattice& lattice);
  /// @param points sensor frame, metres
  /// @throws DataError if a point is beyond the lattice
  void add(const std::vector<Eigen::Vector3f>& points, const Pose& T_world_sensor, int threads);
  /// The map; the builder is empty afterwards.
  MapPoints finish();

 private:
  struct Entry {
    std::uint32_t id;
    Eigen::Vector3f sum;  ///< The sum of the offsets from the cell's centre, metres.
    std::uint32_t count;
  };
  struct OpenBlock {
    VoxelKey key;
    std::vector<Entry> entries;
    std::size_t merged = 0;  ///< This number of first entries are of different cells.
  };
  void append(VoxelKey block, const Entry& entry);
  void merge(OpenBlock& block);
  void move_block(OpenBlock& from, MapPoints& to) const;

  const CellLattice& lattice_;
  VoxelMap<std::uint32_t> block_of_;
  std::vector<OpenBlock> blocks_;
  std::vector<std::uint32_t> slot_;  ///< Scratch: place of a cell's entry, by cell.
};

}  // namespace raymoval::removert_method
