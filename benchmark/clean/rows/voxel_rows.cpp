// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/voxel_rows.h"

#include <algorithm>
#include <cstring>

namespace raymoval {
namespace {

constexpr std::uint64_t kRowsPerBlock = 16384;
constexpr std::size_t kCellsPerPiece = 65536;

}  // namespace

VoxelRows::VoxelRows(const RecordLayout& layout, double cell_size, const Eigen::Vector3d& origin)
    : layout_(layout),
      at_(position_fields(layout, "a map")),
      keeps_rows_(layout.fields.size() > 3),
      cell_size_(cell_size),
      origin_(origin) {
  if (const PointField* found = intensity_field(layout)) {
    intensity_ = *found;
    keeps_rows_ = layout.fields.size() > 4;
  }
}

std::byte* VoxelRows::row_of(const Cell& cell) const {
  return blocks_[cell.row / kRowsPerBlock].get() + cell.row % kRowsPerBlock * layout_.row_bytes;
}

void VoxelRows::keep_row(Cell& cell, bool is_new, const std::byte* row) {
  if (is_new) {
    cell.row = cells_.size() - 1;
    if (cell.row % kRowsPerBlock == 0) {
      blocks_.push_back(std::make_unique<std::byte[]>(kRowsPerBlock * layout_.row_bytes));
    }
  }
  std::memcpy(row_of(cell), row, layout_.row_bytes);
}

void VoxelRows::add(const ScanRows& scan, std::size_t point) {
  const Eigen::Vector3d offset = scan.world[point] - origin_;
  const VoxelIndex index = voxel_index(offset, 1.0 / cell_size_);
  const auto [place, is_new] = cells_.try_emplace(voxel_key(index));
  Cell& cell = place.value();
  cell.sum += offset;
  if (intensity_) cell.intensity += scan.rows.value(point, *intensity_);
  ++cell.count;
  if (!keeps_rows_) return;
  const Eigen::Vector3d from_middle =
      offset / cell_size_ - index.cast<double>() - Eigen::Vector3d::Constant(0.5);
  const auto distance = static_cast<float>(from_middle.squaredNorm());
  if (!(distance < cell.from_middle)) return;
  cell.from_middle = distance;
  keep_row(cell, is_new, scan.rows.row(point));
}

void VoxelRows::append(const Cell& cell, ScanRows& piece) const {
  const std::size_t place = piece.world.size();
  const auto count = static_cast<double>(cell.count);
  piece.world.push_back(origin_ + cell.sum / count);
  piece.rows.bytes.resize(piece.rows.bytes.size() + layout_.row_bytes);
  piece.rows.width = place + 1;
  if (keeps_rows_) std::memcpy(piece.rows.row(place), row_of(cell), layout_.row_bytes);
  const Eigen::Vector3d& mean = piece.world.back();
  piece.rows.set_value(place, at_.x, mean.x());
  piece.rows.set_value(place, at_.y, mean.y());
  piece.rows.set_value(place, at_.z, mean.z());
  if (intensity_) piece.rows.set_value(place, *intensity_, cell.intensity / count);
}

void VoxelRows::take(const std::function<void(const ScanRows& piece)>& give) {
  std::vector<VoxelKey> keys;
  keys.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  for (std::size_t first = 0; first < keys.size(); first += kCellsPerPiece) {
    ScanRows piece{{layout_, {}, 0, 1}, {}};
    const std::size_t end = std::min(keys.size(), first + kCellsPerPiece);
    piece.rows.bytes.reserve((end - first) * layout_.row_bytes);
    for (std::size_t i = first; i < end; ++i) append(cells_.at(keys[i]), piece);
    give(piece);
  }
  cells_.clear();
  blocks_.clear();
}

}  // namespace raymoval
