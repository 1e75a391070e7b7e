// SPDX-License-Identifier: MIT
#include "benchmark/clean/map_cleaner.h"

#include <algorithm>

#include "core/scan/local_frame.h"

namespace raymoval {

MapPrecision map_precision(const ScanSource& scans) {
  MapPrecision precision;
  precision.origin = lattice_origin(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans.pose(i).translation().cwiseAbs().maxCoeff() > kFarFromOrigin) {
      precision.coordinates = Coordinates::kDouble;
    }
  }
  return precision;
}

void MapWriter::start(bool with_reflectance) {
  file_.start(with_reflectance, precision_.coordinates);
  started_ = true;
}

void MapWriter::write_buffer() {
  file_.add_exact(points_, reflectance_);
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
      points_.push_back(world);
      reflectance_.push_back(reflectance);
      continue;
    }
    const Eigen::Vector3d offset = world - precision_.origin;
    Cell& cell = cells_[voxel_key(voxel_index(offset, 1.0 / voxel_size_))];
    cell.sum += offset;
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
    points_.push_back(precision_.origin + cell.sum / count);
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
