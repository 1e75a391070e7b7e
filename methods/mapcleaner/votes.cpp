// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/votes.h"

#include <algorithm>

#include "core/parallel.h"

namespace raymoval::mapcleaner_method {
namespace {

/// Side of a tile, metres; affects only the time.
constexpr double kTile = 16.0;
/// Work for a thread at a time; no effect on the result.
constexpr std::size_t kVoxelsATask = 16 * ImageFrame::Batch::kSize;

}  // namespace

VoxelVotes::VoxelVotes(const Parameters& parameters, const ThinnedPoints& voxels,
                       const SensorModel& sensor)
    : radius_(parameters.submap_radius),
      travel_(parameters.submap_travel),
      voxels_(voxels),
      image_(parameters, sensor),
      balance_(voxels.size(), 0) {
  sort_into_tiles();
}

void VoxelVotes::sort_into_tiles() {
  std::vector<VoxelKey> keys(voxels_.size());
  by_tile_.resize(voxels_.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Eigen::Vector3d centroid = voxels_.centroid(i);
    keys[i] = voxel_key(voxel_index({centroid.x(), centroid.y(), 0.0}, 1.0 / kTile));
    by_tile_[i] = static_cast<std::uint32_t>(i);
  }
  std::stable_sort(by_tile_.begin(), by_tile_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  for (std::size_t i = 0; i < by_tile_.size(); ++i) {
    const Eigen::Vector3d centroid = voxels_.centroid(by_tile_[i]);
    if (i == 0 || keys[by_tile_[i]] != keys[by_tile_[i - 1]]) {
      tiles_.push_back({centroid, centroid, i, i});
    }
    Tile& tile = tiles_.back();
    tile.low = tile.low.cwiseMin(centroid);
    tile.high = tile.high.cwiseMax(centroid);
    tile.end = i + 1;
  }
}

void VoxelVotes::choose_submap(const Eigen::Vector3d& place) {
  submap_ = {};
  submap_.origin = place;
  for (const Tile& tile : tiles_) {
    const Eigen::Vector3d nearest = place.cwiseMax(tile.low).cwiseMin(tile.high);
    if ((nearest - place).norm() > radius_) continue;
    for (std::size_t i = tile.begin; i < tile.end; ++i) {
      const Eigen::Vector3d from_place = voxels_.centroid(by_tile_[i]) - place;
      if (from_place.norm() > radius_) continue;
      submap_.voxel.push_back(by_tile_[i]);
      submap_.x.push_back(static_cast<float>(from_place.x()));
      submap_.y.push_back(static_cast<float>(from_place.y()));
      submap_.z.push_back(static_cast<float>(from_place.z()));
    }
  }
}

void VoxelVotes::add(const Scan& scan, const RunContext& context) {
  if (scan.points.empty()) return;
  const Eigen::Vector3d place = scan.T_world_sensor.translation();
  if (!has_submap_ || (place - submap_.origin).norm() > travel_) choose_submap(place);
  has_submap_ = true;
  image_.fill(scan, context.threads);
  const Pose T_sensor_submap =
      scan.T_world_sensor.inverse() * Pose(Eigen::Translation3d(submap_.origin));
  const Eigen::Isometry3f single = T_sensor_submap.cast<float>();
  parallel_chunks(context.threads, submap_.voxel.size(), kVoxelsATask,
                  [&](std::size_t from, std::size_t to) {
                    for (std::size_t begin = from; begin < to; begin += ImageFrame::Batch::kSize) {
                      vote(single, begin, std::min(to, begin + ImageFrame::Batch::kSize));
                    }
                  });
}

void VoxelVotes::vote(const Eigen::Isometry3f& T_sensor_submap, std::size_t begin,
                      std::size_t end) {
  const auto& m = T_sensor_submap.matrix();
  const float* const x = submap_.x.data() + begin;
  const float* const y = submap_.y.data() + begin;
  const float* const z = submap_.z.data() + begin;
  ImageFrame::Batch batch;
  for (std::size_t i = 0; i < end - begin; ++i) {
    batch.x[i] = m(0, 0) * x[i] + m(0, 1) * y[i] + m(0, 2) * z[i] + m(0, 3);
    batch.y[i] = m(1, 0) * x[i] + m(1, 1) * y[i] + m(1, 2) * z[i] + m(1, 3);
    batch.z[i] = m(2, 0) * x[i] + m(2, 1) * y[i] + m(2, 2) * z[i] + m(2, 3);
  }
  image_.frame().project(batch, static_cast<int>(end - begin));
  for (std::size_t i = 0; i < end - begin; ++i) {
    const int pixel = image_.frame().pixel_of(batch, static_cast<int>(i));
    if (pixel < 0) continue;
    const Sight sight = image_.look(pixel, batch.range[i]);
    if (sight == Sight::kNothing) continue;
    balance_[submap_.voxel[begin + i]] += sight == Sight::kSeenThrough ? 1 : -1;
  }
}

}  // namespace raymoval::mapcleaner_method
