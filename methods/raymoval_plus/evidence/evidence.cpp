// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// The number of new voxels that a thread asks all kept scans about at a time. A scan finds some
/// thousands, so that all threads have work. It changes no answer.
constexpr std::size_t kVoxelsATask = 256;

/// Voxels with more scans that agree are decided on by the formula itself, and those that are heard
/// at their own height.
constexpr int kTabulatedScans = 256;

/// The tiles that any of the scans may say something of.
std::vector<std::uint32_t> tiles_near(std::span<const PosedImage> images, double range,
                                      const EvidenceMap& map) {
  std::vector<std::uint32_t> tiles;
  for (const PosedImage& scan : images) {
    const auto near = map.tiles_near(scan.T_world_sensor.translation(), range);
    tiles.insert(tiles.end(), near.begin(), near.end());
  }
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

/// How many scans that saw through a voxel are not heard.
int unheard_scans(const VoxelEvidence& evidence, const Parameters& parameters) {
  return is_settled(evidence, parameters) ? evidence.far.between_agreeing() : 0;
}

/// The numbers of scans that decide on a voxel.
struct HeardScans {
  int free, agree;
};

/// Scans before the first and after the last that agrees are left out only where so many times as
/// many agree as tell the heights of a voxel's points.
constexpr int kColumnTimes = 3;

/// A beam sees through a roof that is seen from below if it passes at most so many metres below or
/// above its points: the noise of what is measured. With anything else it is half a voxel, for a
/// thing's side goes on below and above the points that were seen; a roof does not, and a beam
/// passes closer than that just before it meets it.
constexpr float kRoofReach = 0.02F;

/// Where enough scans agree, those beside the voxel's points are left out. Before the first and
/// after the last that agrees, these are heard if they see through anything in the voxel's column:
/// where beams are far apart, they would have met a car that came or left, though not in this
/// voxel.
HeardScans heard_scans(const VoxelEvidence& evidence, const Parameters& parameters) {
  if (!is_heard_at_height(evidence, parameters)) return {evidence.free_scans, evidence.agree_scans};
  const ScansBeside& beside = evidence.beside;
  int free = evidence.free_scans + unheard_scans(evidence, parameters);
  free -= beside.free_between_agreeing;
  free = std::min<int>(evidence.free_scans, free);
  if (evidence.agree_scans >= kColumnTimes * parameters.height_scans) {
    free -= beside.column_before + beside.column_since;
  }
  return {free, evidence.agree_scans - beside.agree};
}

/// Tells whether the beams of a scan pass voxels at the height of their points, or of their
/// columns.
class HeightTest {
 public:
  /// @param scan its number
  /// @param origin_z, sensor_z heights of what places are measured from, and of the sensor, metres,
  ///   world frame
  HeightTest(const RangeImage& image, std::size_t scan, double origin_z, double sensor_z,
             const Parameters& parameters, const EvidenceMap& map)
      : image_(image),
        map_(map),
        scan_(scan),
        sensor_z_(sensor_z),
        origin_above_sensor_(static_cast<float>(origin_z - sensor_z)),
        reach_(static_cast<float>(0.5 * parameters.voxel_size)),
        is_asked_(parameters.height_scans > 0 && map.seen_through() == SeenThrough::kInRowOrBelow) {
  }

  /// What the scan says of a voxel.
  /// @param z height of the mean of the voxel's points, metres above what places are measured from
  [[nodiscard]] Observed operator()(std::size_t voxel, const ObservedPlace& place, float z,
                                    const HeightSpan& span) {
    Observed observed{place.observation, place.range, scan_};
    if (!is_asked_) return observed;
    const float mean = origin_above_sensor_ + z;
    const bool is_free = place.observation == Observation::kFree;
    const auto beams_within = [&](float reach) {
      return image_.passing(place, mean + span.low - reach, mean + span.high + reach);
    };
    const auto beams = beams_within(reach_);
    if (is_free && beams.between && mean > 0.0F && !beams_within(kRoofReach).between &&
        map_.is_roof(voxel, cursor_)) {
      observed.is_beside = observed.is_beside_column = true;
      return observed;
    }
    observed.is_beside = !beams.between;
    observed.is_beside_column = observed.is_beside && is_free && !reaches(voxel, beams.below) &&
                                !reaches(voxel, beams.above);
    return observed;
  }

 private:
  /// @param beam height, metres above the sensor
  [[nodiscard]] bool reaches(std::size_t voxel, float beam) {
    return std::isfinite(beam) && map_.column_reaches(voxel, sensor_z_ + beam, cursor_);
  }

  const RangeImage& image_;
  const EvidenceMap& map_;
  EvidenceMap::Blocks::Cursor cursor_;
  std::size_t scan_;
  double sensor_z_;                    ///< Metres.
  float origin_above_sensor_, reach_;  ///< Metres.
  bool is_asked_;
};

}  // namespace

void add_evidence(std::span<const PosedImage> images, const Parameters& parameters,
                  WhenToDecide when, const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "evidence");
  map.update_means();
  const auto tiles = tiles_near(images, parameters.evidence_range_max, map);
  const Decisions decided(parameters);
  // A thread takes one tile at a time, so that one thread decides on all voxels of a block, and the
  // tile's voxels stay in its cache from scan to scan.
  parallel_for(context.threads, tiles.size(), 1, [&](std::size_t t) {
    EvidenceMap::Tile& tile = map.tile(tiles[t]);
    thread_local std::vector<ObservedPlace> observed;
    for (const auto& [image, T_world_sensor, scan] : images) {
      image->observe(tile.places,
                     T_world_sensor.inverse(Eigen::Isometry) * Eigen::Translation3d(tile.origin),
                     map.seen_through(), observed);
      HeightTest test(*image, scan, tile.origin.z(), T_world_sensor.translation().z(), parameters,
                      map);
      for (const ObservedPlace& place : observed) {
        VoxelEvidence& evidence = tile.evidence[place.place];
        const Observed what = test(tile.voxels[place.place], place,
                                   tile.places[3 * place.place + 2], tile.spans[place.place]);
        if (when == WhenToDecide::kLater) {
          add_observation(what, parameters, evidence);
          continue;
        }
        const Verdict before = decided(evidence);
        add_observation(what, parameters, evidence);
        const Verdict now = decided(evidence);
        // Most observations change no decision, and then the map need not be written.
        if (now != before) map.set_decision(tile.voxels[place.place], now);
      }
    }
  });
}

void decide_all(const Parameters& parameters, const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "evidence");
  const Decisions decided(parameters);
  for (std::size_t voxel = 0; voxel < map.size(); ++voxel) {
    map.set_decision(voxel, decided(map.evidence(voxel)));
  }
}

void EarlierScans::add_evidence(std::size_t first_voxel, const Eigen::Vector3d& center,
                                WhenToDecide when, const RunContext& context,
                                EvidenceMap& map) const {
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
      scan.image.observe(places, scan.T_sensor_world * Eigen::Translation3d(center),
                         map.seen_through(), observed);
      HeightTest test(scan.image, scan.number, center.z(), scan.sensor_height, parameters_, map);
      for (const ObservedPlace& place : observed) {
        const std::size_t voxel = first_voxel + begin + place.place;
        add_observation(test(voxel, place, places[3 * place.place + 2], map.span(voxel)),
                        parameters_, map.evidence(voxel));
      }
    }
  });
  if (when == WhenToDecide::kLater) return;
  const Decisions decided(parameters_);
  for (std::size_t voxel = first_voxel; voxel < map.size(); ++voxel) {
    map.set_decision(voxel, decided(map.evidence(voxel)));
  }
}

void EarlierScans::keep(RangeImage&& image, const Pose& T_world_sensor, std::size_t scan) {
  const bool is_kept = scans_++ % static_cast<std::size_t>(parameters_.history_step) == 0;
  if (!is_kept || parameters_.history_scans == 0) return;
  const Pose T_sensor_world = T_world_sensor.inverse(Eigen::Isometry);
  const double sensor_height = T_world_sensor.translation().z();
  if (kept_.size() < static_cast<std::size_t>(parameters_.history_scans)) {
    kept_.push_back({std::move(image), T_sensor_world, sensor_height, scan});
    return;
  }
  // The memory of the oldest image is that of the next one.
  std::rotate(kept_.begin(), kept_.begin() + 1, kept_.end());
  std::swap(kept_.back().image, image);
  kept_.back().T_sensor_world = T_sensor_world;
  kept_.back().sensor_height = sensor_height;
  kept_.back().number = scan;
}

void add_observation(const Observed& observed, const Parameters& parameters,
                     VoxelEvidence& evidence) {
  ScansBeside& beside = evidence.beside;
  const auto count_up = [](std::uint16_t& count) {
    if (count < 0xFFFFU) ++count;
  };
  if (observed.observation == Observation::kAgree) {
    evidence.last_agree = static_cast<std::uint32_t>(observed.scan);
    if (evidence.agree_scans == 0) evidence.first_agree = evidence.last_agree;
    const int all_free = evidence.free_scans + unheard_scans(evidence, parameters);
    evidence.far.agree(observed.range);
    if (observed.is_beside && evidence.agree_scans < 0xFFFFU) ++beside.agree;
    count_up(evidence.agree_scans);
    evidence.free_scans = static_cast<std::uint16_t>(
        std::clamp(all_free - unheard_scans(evidence, parameters), 0, 0xFFFF));
    evidence.trailing_free = 0;
    beside.free_between_agreeing = static_cast<std::uint16_t>(
        std::min(beside.free_between_agreeing + beside.free_since, 0xFFFF));
    beside.free_since = beside.column_since = 0;
  } else if (observed.observation == Observation::kFree) {
    count_up(evidence.free_scans);
    if (evidence.agree_scans > 0) evidence.far.see_through(observed.range);
    if (evidence.agree_scans > 0 && observed.is_beside) count_up(beside.free_since);
    if (observed.is_beside_column) {
      count_up(evidence.agree_scans > 0 ? beside.column_since : beside.column_before);
      return;
    }
    if (observed.range > static_cast<float>(parameters.run_range)) return;
    count_up(evidence.trailing_free);
    if (evidence.agree_scans == 0) count_up(evidence.leading_free);
  }
}

Verdict decide(const VoxelEvidence& evidence, const Parameters& parameters) {
  const HeardScans heard = heard_scans(evidence, parameters);
  const double needed = parameters.free_constant + parameters.free_per_agree * heard.agree;
  const bool came_or_left =
      parameters.run_scans > 0 && (evidence.leading_free >= parameters.run_scans ||
                                   evidence.trailing_free >= parameters.run_scans);
  if (came_or_left || heard.free >= needed) return Verdict::kDynamic;
  return evidence.agree_scans >= parameters.static_agree ? Verdict::kStatic : Verdict::kUndecided;
}

Decisions::Decisions(const Parameters& parameters)
    : parameters_(parameters),
      run_(parameters.run_scans > 0 ? parameters.run_scans : std::numeric_limits<int>::max()),
      needed_(parameters.height_scans > 0 ? std::min(parameters.height_scans, kTabulatedScans)
                                          : kTabulatedScans) {
  for (std::size_t agree = 0; agree < needed_.size(); ++agree) {
    const double needed =
        parameters.free_constant + parameters.free_per_agree * static_cast<double>(agree);
    needed_[agree] = static_cast<int>(std::ceil(needed));
  }
}

bool is_settled(const VoxelEvidence& evidence, const Parameters& parameters) {
  return parameters.settled_scans > 0 && evidence.agree_scans >= parameters.settled_scans;
}

bool is_heard_at_height(const VoxelEvidence& evidence, const Parameters& parameters) {
  return parameters.height_scans > 0 && evidence.agree_scans >= parameters.height_scans;
}

bool was_always_there(const VoxelEvidence& evidence, const Parameters& parameters) {
  return evidence.free_scans == 0 && is_settled(evidence, parameters);
}

}  // namespace raymoval::raymoval_plus_method
