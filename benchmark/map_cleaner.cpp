// SPDX-License-Identifier: MIT
#include "benchmark/map_cleaner.h"

#include <algorithm>

namespace raymoval {

void MapWriter::start(bool with_reflectance) {
  file_.start(with_reflectance);
  started_ = true;
}

void MapWriter::write_buffer() {
  file_.add(points_, reflectance_);
  written_ += points_.size();
  points_.clear();
  reflectance_.clear();
}

void MapWriter::add(const Scan& scan, const Mask& mask, std::uint8_t wanted) {
  if (scan.size() == 0) return;
  const bool with_reflectance = !scan.reflectance.empty();
  if (!with_reflectance) has_reflectance_ = false;
  if (voxel_size_ <= 0.0 && !started_) start(with_reflectance);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (mask[i] != wanted) continue;
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[i].cast<double>();
    const float reflectance = with_reflectance ? scan.reflectance[i] : 0.0F;
    if (voxel_size_ <= 0.0) {
      points_.push_back(world.cast<float>());
      reflectance_.push_back(reflectance);
      continue;
    }
    Cell& cell = cells_[voxel_key(voxel_index(world, 1.0 / voxel_size_))];
    cell.sum += world;
    cell.reflectance += static_cast<double>(reflectance);
    ++cell.count;
  }
  if (voxel_size_ <= 0.0) write_buffer();
}

void MapWriter::write_cells() {
  constexpr std::size_t kPiece = 65536;
  std::vector<VoxelKey> keys;
  keys.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  for (const VoxelKey key : keys) {
    const Cell& cell = cells_.at(key);
    const auto count = static_cast<double>(cell.count);
    points_.push_back((cell.sum / count).cast<float>());
    reflectance_.push_back(static_cast<float>(cell.reflectance / count));
    if (points_.size() == kPiece) write_buffer();
  }
  write_buffer();
}

std::uint64_t MapWriter::finish() {
  if (!started_) start(has_reflectance_);
  write_cells();
  file_.finish();
  return written_;
}

}  // namespace raymoval
