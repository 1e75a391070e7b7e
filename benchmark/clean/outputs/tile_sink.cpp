// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/tile_sink.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/files.h"
#include "core/sampling.h"
#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kRowsPerPiece = 65536;

std::string tile_name(const std::array<std::int64_t, 2>& place) {
  return "tile_" + std::to_string(place[0]) + "_" + std::to_string(place[1]);
}

/// The tile of a position in the upright world; nothing where double precision cannot separate
/// neighbouring tiles.
std::optional<std::array<std::int64_t, 2>> tile_of(const Eigen::Vector3d& upright, double size_m) {
  const double x = std::floor(upright.x() / size_m), y = std::floor(upright.y() / size_m);
  constexpr double kFarthest = 1e15;
  if (!(std::abs(x) < kFarthest && std::abs(y) < kFarthest)) return std::nullopt;
  return {{static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)}};
}

ordered_json vector_json(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

}  // namespace

TileSink::TileSink(const std::filesystem::path& folder, const RecordLayout& layout, Tiling tiling)
    : folder_(folder), layout_(layout), tiling_(std::move(tiling)) {
  // Refuses at once a format that no tile can be written in.
  PointRecordWriter trial(folder_.place() / ("tile" + tiling_.extension), tiling_.writing);
  trial.start(layout_);
}

TileSink::Place TileSink::place_of(const Eigen::Vector3d& world) const {
  if (const auto place = tile_of(tiling_.T_upright_world * world, tiling_.size_m)) return *place;
  throw DataError(folder_.path().string() + ": a point lies at " + number_text(world.x()) + ", " +
                  number_text(world.y()) + ", " + number_text(world.z()) +
                  " m, beyond the last tile. Nothing was written; check the poses.");
}

void check_tile_count(const Sequence& sequence, double size_m,
                      const std::optional<RangeLimits>& kept) {
  constexpr std::size_t kScans = 10;
  std::set<std::array<std::int64_t, 2>> tiles;
  const std::size_t count = sequence.scans->size();
  for (const std::size_t i : evenly_spread(count, kScans)) {
    const Scan scan = sequence.scans->load(i);
    const Pose T_upright_sensor = sequence.upright_frame() * scan.T_world_sensor;
    for (const Eigen::Vector3f& point : scan.points) {
      if (kept && !kept->contains(point.cast<double>().norm())) continue;
      if (const auto tile = tile_of(T_upright_sensor * point.cast<double>(), size_m)) {
        tiles.insert(*tile);
      }
    }
    if (tiles.size() <= TileSink::kMostTiles) continue;
    throw UsageError("--tiles: the points of " + counted_text(std::min(count, kScans), "scan") +
                     " of '" + sequence.name + "' lie in more than " +
                     grouped_text(TileSink::kMostTiles) + " tiles of " + number_text(size_m) +
                     " m, which is the limit of a map. Choose larger tiles, such as --tiles 100 "
                     "(metres).");
  }
}

std::filesystem::path TileSink::spool_of(const Place& place) const {
  return folder_.place() / (tile_name(place) + ".rows");
}

TileSink::Tile& TileSink::tile_at(const Place& place) {
  const auto [found, is_new] = tiles_.try_emplace(place);
  if (is_new && tiles_.size() > kMostTiles) {
    throw DataError(
        folder_.path().string() + ": the map has more than " + grouped_text(kMostTiles) +
        " tiles of " + number_text(tiling_.size_m) +
        " m. Nothing was written; choose larger --tiles, and check the units of the poses.");
  }
  return found->second;
}

void TileSink::add(const ScanRows& rows) {
  const std::size_t bytes = layout_.row_bytes;
  if (las_ == nullptr) las_ = rows.rows.las;
  Place last{};
  Tile* tile = nullptr;
  for (std::size_t i = 0; i < rows.world.size(); ++i) {
    const Place place = place_of(rows.world[i]);
    if (tile == nullptr || place != last) {
      tile = &tile_at(place);
      last = place;
    }
    tile->low = tile->low.cwiseMin(rows.world[i]);
    tile->high = tile->high.cwiseMax(rows.world[i]);
    tile->waiting.append(reinterpret_cast<const char*>(rows.rows.row(i)), bytes);
    ++tile->points;
  }
  waiting_ += rows.world.size() * bytes;
  if (waiting_ > tiling_.most_waiting) spool_all();
}

void TileSink::spool_all() {
  for (auto& [place, tile] : tiles_) {
    if (tile.waiting.empty()) continue;
    const std::filesystem::path path = spool_of(place);
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!file.valid() || !write_at(file.get(), tile.waiting, tile.spooled)) {
      throw DataError(path.string() + ": cannot be written (" +
                      std::generic_category().message(errno) +
                      "). Nothing was changed; free space or choose another folder.");
    }
    tile.spooled += tile.waiting.size();
    std::string().swap(tile.waiting);
  }
  waiting_ = 0;
}

void TileSink::write_tile(const Place& place, Tile& tile) const {
  PointRecordWriter file(folder_.place() / (tile_name(place) + tiling_.extension), tiling_.writing);
  file.start(layout_);
  const auto give = [&](std::string_view bytes) {
    if (bytes.empty()) return;
    PointRecords rows{layout_, std::vector<std::byte>(bytes.size()), 0, 1};
    std::memcpy(rows.bytes.data(), bytes.data(), bytes.size());
    rows.width = rows.size();
    rows.las = las_;
    file.add(rows);
  };
  const std::size_t piece = kRowsPerPiece * layout_.row_bytes;
  for (std::uint64_t at = 0; at < tile.spooled; at += piece) {
    give(read_piece(spool_of(place), at, piece));
  }
  give(tile.waiting);
  std::string().swap(tile.waiting);
  file.finish();
  file.commit();
  std::error_code ignored;
  if (tile.spooled > 0) std::filesystem::remove(spool_of(place), ignored);
}

void TileSink::write_manifest() const {
  ordered_json manifest;
  manifest["written_by"] = "raymoval clean --tiles";
  manifest["version"] = 1;
  manifest["format"] = tiling_.extension.substr(1);
  manifest["tile_size_m"] = tiling_.size_m;
  manifest["origin"] = {0.0, 0.0, 0.0};
  manifest["crs"] = nullptr;
  manifest["fields"] = ordered_json::array();
  for (const PointField& field : layout_.fields) manifest["fields"].push_back(field.text());
  manifest["R_upright_world"] = ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    manifest["R_upright_world"].push_back(
        vector_json(tiling_.T_upright_world.linear().row(row).transpose()));
  }
  std::uint64_t points = 0;
  ordered_json list = ordered_json::array();
  for (const auto& [place, tile] : tiles_) {
    points += tile.points;
    list.push_back({{"file", tile_name(place) + tiling_.extension},
                    {"tile", place},
                    {"points", tile.points},
                    {"min", vector_json(tile.low)},
                    {"max", vector_json(tile.high)}});
  }
  manifest["points"] = points;
  manifest["tiles"] = std::move(list);
  write_atomically(folder_.place() / "manifest.json", manifest.dump(2) + "\n");
}

void TileSink::finish() {
  for (auto& [place, tile] : tiles_) write_tile(place, tile);
  write_manifest();
}

}  // namespace raymoval
