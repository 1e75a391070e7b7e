// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/clean/outputs/output_folder.h"
#include "benchmark/clean/outputs/row_sink.h"
#include "core/scan/range_limits.h"
#include "datasets/sequence.h"

namespace raymoval {

/// The division of a map into tiles.
struct Tiling {
  double size_m = 100.0;  ///< The edge of a tile.
  /// The rotation that turns up to z: tiles are squares in the horizontal plane.
  Pose T_upright_world = Pose::Identity();
  std::string extension = ".pcd";  ///< The format of the tiles.
  RecordWriting writing = {};
  std::size_t most_waiting = std::size_t{32} << 20;  ///< Bytes of rows buffered in memory.
};

/// Checks in a few scans, before the work, that there are not too many tiles.
/// @param size_m of a tile, or of a voxel if that is larger
/// @param kept ranges that are in the map
/// @throws UsageError if these scans alone fill more than `TileSink::kMostTiles`
void check_tile_count(const Sequence& sequence, double size_m,
                      const std::optional<RangeLimits>& kept);

/// Cuts rows into square tiles, each a file in a folder, with a manifest.json that lists them. The
/// tile of a point is floor(x / size), floor(y / size) of its position in the upright world, so
/// that tiles of different runs fit together. Each tile keeps its rows in order of arrival.
///
/// Rows are spooled to one file per tile in the folder, with some megabytes of them buffered in
/// memory. At most one file is open at a time, whatever the number of tiles.
class TileSink : public RowSink {
 public:
  /// More tiles are refused: they suggest a mistake of units, and would take minutes to write.
  static constexpr std::size_t kMostTiles = 10'000;

  /// @throws DataError if the folder cannot be made; UsageError for an extension that is unknown
  TileSink(const std::filesystem::path& folder, const RecordLayout& layout, Tiling tiling);
  void add(const ScanRows& rows) override;
  void finish() override;
  void commit_with(Replacements& together) override { folder_.commit_with(together); }

 private:
  using Place = std::array<std::int64_t, 2>;
  struct Tile {
    std::string waiting;        ///< Rows that are not in the tile's file yet.
    std::uint64_t spooled = 0;  ///< Bytes in that file.
    std::uint64_t points = 0;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300);
    Eigen::Vector3d high = Eigen::Vector3d::Constant(-1e300);
  };
  [[nodiscard]] Place place_of(const Eigen::Vector3d& world) const;
  [[nodiscard]] std::filesystem::path spool_of(const Place& place) const;
  Tile& tile_at(const Place& place);
  void spool_all();
  void write_tile(const Place& place, Tile& tile) const;
  void write_manifest() const;

  OutputFolder folder_;
  RecordLayout layout_;
  Tiling tiling_;
  std::map<Place, Tile> tiles_;
  std::size_t waiting_ = 0;              ///< Bytes of all tiles.
  std::shared_ptr<const LasNotes> las_;  ///< Of the first rows.
};

}  // namespace raymoval
