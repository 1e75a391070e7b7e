// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// The number of new voxels that a thread asks all kept scans about at a time. A scan finds some
/// thousands, so that all threads have work. It changes no answer.
constexpr std::size_t kVoxelsATask = 256;

}  // namespace

void add_evidence(const RangeImage& image, const Pose& T_world_sensor, const Parameters& parameters,
                  const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "evidence");
  const Pose T_sensor_world = T_world_sensor.inverse(Eigen::Isometry);
  map.update_means();
  const auto tiles = map.tiles_near(T_world_sensor.translation(), parameters.evidence_range_max);
  // A thread takes one tile at a time, so that one thread decides on all voxels of a block.
  parallel_for(context.threads, tiles.size(), 1, [&](std::size_t t) {
    EvidenceMap::Tile& tile = *tiles[t];
    thread_local std::vector<ObservedPlace> observed;
    image.observe(tile.places, T_sensor_world * Eigen::Translation3d(tile.origin), observed);
    for (const ObservedPlace& place : observed) {
      VoxelEvidence& evidence = tile.evidence[place.place];
      const bool is_first = evidence.free_scans == 0 && evidence.agree_scans == 0;
      const Verdict before = decide(evidence, parameters);
      add_observation(place.observation, place.range, parameters, evidence);
      const Verdict now = decide(evidence, parameters);
      // Most observations change no decision, and then the map need not be written.
      if (is_first || now != before) map.set_decision(tile.voxels[place.place], now);
    }
  });
}

void EarlierScans::add_evidence(std::size_t first_voxel, const Eigen::Vector3d& center,
                                const RunContext& context, EvidenceMap& map) const {
  const StageScope timed(context.times, "earlier scans");
  const std::size_t fresh = map.size() - first_voxel;
  parallel_chunks(context.threads, fresh, kVoxelsATask, [&](std::size_t begin, std::size_t end) {
    std::vector<float> places;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f place = (map.centroid(first_voxel + i) - center).cast<float>();
      places.insert(places.end(), place.data(), place.data() + 3);
    }
    std::vector<ObservedPlace> observed;
    for (const EarlierScan& scan : kept_) {
      scan.image.observe(places, scan.T_sensor_world * Eigen::Translation3d(center), observed);
      for (const ObservedPlace& place : observed) {
        add_observation(place.observation, place.range, parameters_,
                        map.evidence(first_voxel + begin + place.place));
      }
    }
  });
  for (std::size_t voxel = first_voxel; voxel < map.size(); ++voxel) {
    map.set_decision(voxel, decide(map.evidence(voxel), parameters_));
  }
}

void EarlierScans::keep(const RangeImage& image, const Pose& T_world_sensor) {
  const bool is_kept = scans_++ % static_cast<std::size_t>(parameters_.history_step) == 0;
  if (!is_kept || parameters_.history_scans == 0) return;
  if (kept_.size() == static_cast<std::size_t>(parameters_.history_scans)) {
    kept_.erase(kept_.begin());
  }
  kept_.push_back({image, T_world_sensor.inverse(Eigen::Isometry)});
}

void add_observation(Observation observation, float range, const Parameters& parameters,
                     VoxelEvidence& evidence) {
  const auto count_up = [](std::uint16_t& count) {
    if (count < 0xFFFFU) ++count;
  };
  if (observation == Observation::kAgree) {
    count_up(evidence.agree_scans);
    evidence.trailing_free = 0;
  } else if (observation == Observation::kFree) {
    count_up(evidence.free_scans);
    if (range > static_cast<float>(parameters.run_range)) return;
    count_up(evidence.trailing_free);
    if (evidence.agree_scans == 0) count_up(evidence.leading_free);
  }
}

Verdict decide(const VoxelEvidence& evidence, const Parameters& parameters) {
  const double needed = parameters.free_constant + parameters.free_per_agree * evidence.agree_scans;
  const bool came_or_left =
      parameters.run_scans > 0 && (evidence.leading_free >= parameters.run_scans ||
                                   evidence.trailing_free >= parameters.run_scans);
  if (came_or_left || evidence.free_scans >= needed) return Verdict::kDynamic;
  return evidence.agree_scans >= parameters.static_agree ? Verdict::kStatic : Verdict::kUndecided;
}

bool was_always_there(const VoxelEvidence& evidence, const Parameters& parameters) {
  return parameters.settled_scans > 0 && evidence.free_scans == 0 &&
         evidence.agree_scans >= parameters.settled_scans;
}

}  // namespace raymoval::raymoval_plus_method
