// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/arriving_scans.h"

#include <utility>

#include "core/parallel.h"
#include "methods/raymoval_plus/evidence.h"
#include "methods/raymoval_plus/verdicts.h"

namespace raymoval {

ArrivingScans::ArrivingScans(const SensorModel& sensor, const RaymovalPlusParameters& parameters)
    : parameters_(parameters),
      terrain_(parameters),
      map_(parameters.voxel_size),
      image_(sensor, parameters) {}

WorldScan ArrivingScans::add(Scan scan, int threads, StageTimes* times) {
  WorldScan world = in_world(std::move(scan), threads);
  if (parameters_.terrain) {
    const StageScope timed(times, "terrain");
    terrain_.add(world.points);
    if (scans_ % static_cast<std::size_t>(parameters_.terrain_period) == 0) {
      terrain_.update(threads);
    }
  }
  const std::size_t first_voxel = map_.size();
  {
    const StageScope timed(times, "voxels");
    measure_heights(terrain_, parameters_, threads, world);
    add_to_map(parameters_, world, map_);
  }
  {
    const StageScope timed(times, "range image");
    image_.fill(world.scan);
  }
  {
    const StageScope timed(times, "earlier scans");
    ask_kept_scans(first_voxel, world.scan.T_world_sensor.translation(), threads);
  }
  const StageScope timed(times, "evidence");
  add_evidence(image_, world.scan.T_world_sensor, parameters_, threads, map_);
  if (scans_ % static_cast<std::size_t>(parameters_.history_step) == 0) {
    keep(image_, world.scan.T_world_sensor);
  }
  ++scans_;
  return world;
}

void ArrivingScans::ask_kept_scans(std::size_t first_voxel, const Eigen::Vector3d& center,
                                   int threads) {
  parallel_chunks(threads, map_.size() - first_voxel, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<float> places;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f place = (map_.centroid(first_voxel + i) - center).cast<float>();
      places.insert(places.end(), place.data(), place.data() + 3);
    }
    std::vector<SeenPlace> seen;
    for (const Kept& kept : kept_) {
      kept.image.see(places, kept.T_sensor_world * Eigen::Translation3d(center), seen);
      for (const SeenPlace& place : seen) {
        count(place.seen, place.range, parameters_,
              map_.evidence(first_voxel + begin + place.place));
      }
    }
  });
  for (std::size_t voxel = first_voxel; voxel < map_.size(); ++voxel) {
    map_.set_decision(voxel, decide(map_.evidence(voxel), parameters_));
  }
}

void ArrivingScans::keep(RangeImage image, const Pose& T_world_sensor) {
  if (parameters_.history_scans == 0) return;
  if (kept_.size() == static_cast<std::size_t>(parameters_.history_scans)) {
    kept_.erase(kept_.begin());
  }
  kept_.push_back({std::move(image), T_world_sensor.inverse(Eigen::Isometry)});
}

}  // namespace raymoval
