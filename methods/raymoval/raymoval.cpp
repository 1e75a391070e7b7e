// SPDX-License-Identifier: MIT
// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping", section 3.
// Equation numbers are the order of the numbered equations there.
#include "methods/raymoval/raymoval.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "methods/raymoval/angular_grid.h"
#include "methods/raymoval/consistency.h"
#include "methods/raymoval/first_hit.h"
#include "methods/raymoval/map_reference.h"
#include "methods/raymoval/static_map.h"
#include "methods/raymoval/validation.h"
#include "methods/scan_passes.h"

namespace raymoval {
namespace {

/// Bins of a step, or `otherwise` where the step is unknown. No sensor of today has finer steps
/// than `most` bins allow; a wrong step then costs no more memory than the finest sensor would.
int bins_of(double width, double step, int otherwise, double most) {
  constexpr double kFewestBins = 36.0;
  if (!(step > 0.0)) return otherwise;
  return static_cast<int>(std::clamp(std::ceil(width / step), kFewestBins, most));
}

AngularGrid grid_for(const SensorModel& sensor, const RaymovalParameters& parameters) {
  const double margin = parameters.elevation_margin * std::numbers::pi / 180.0;
  AngularGrid grid;
  grid.elevation_min = std::max(sensor.elevation_min - margin, -std::numbers::pi / 2.0);
  grid.elevation_max = std::min(sensor.elevation_max + margin, std::numbers::pi / 2.0);
  constexpr double kMostColumns = 7200.0, kMostRows = 720.0;
  grid.azimuth_bins = parameters.azimuth_bins;
  if (grid.azimuth_bins <= 0) {
    grid.azimuth_bins = bins_of(2.0 * std::numbers::pi, sensor.azimuth_step, 720, kMostColumns);
  }
  grid.elevation_bins = parameters.elevation_bins;
  if (grid.elevation_bins <= 0) {
    grid.elevation_bins =
        bins_of(grid.elevation_max - grid.elevation_min, sensor.elevation_step, 450, kMostRows);
  }
  return grid;
}

/// Rows of the grid from one beam to the next, so that a window of that radius holds a return
/// wherever the surface goes on. Beams more than half a degree apart are no witnesses for each
/// other: at 20 m that is 17 cm, about a voxel.
int rows_of_a_beam(const SensorModel& sensor, const AngularGrid& grid,
                   const RaymovalParameters& parameters) {
  if (parameters.erase_elevation_window >= 0) return parameters.erase_elevation_window;
  constexpr double kFarthest = 0.5 * std::numbers::pi / 180.0;
  const double step =
      sensor.elevation_step > 0.0 ? std::min(sensor.elevation_step, kFarthest) : kFarthest;
  return std::clamp(static_cast<int>(std::ceil(step / grid.elevation_step())), 1, 100);
}

CastImage sweep_caster(const AngularGrid& grid, const RayLimits& limits) {
  return [caster = std::make_shared<FirstHitCaster>(grid, limits)](
             OccupancyMap& map, const Pose& T_world_sensor, int threads, FirstHitImage& image) {
    caster->cast(map, T_world_sensor, threads, image);
  };
}

/// A scan with what every step needs of it.
struct PreparedScan {
  Scan scan;
  std::vector<VoxelIndex> voxels;  ///< Of each point, in the world lattice.
  ProjectedScan projected;
};

/// Eqs 12-15 for the candidates of a scan.
Mask validate_scan(const Scan& scan, const std::vector<VoxelIndex>& voxels, const Mask& candidates,
                   const OccupancyMap& static_map, const RaymovalParameters& parameters) {
  std::vector<std::size_t> chosen;
  ScanPoints points;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (candidates[k] == 0) continue;
    chosen.push_back(k);
    points.position.push_back(scan.T_world_sensor * scan.points[k].cast<double>());
    points.voxel.push_back(voxels[k]);
    points.range.push_back(scan.points[k].norm());
  }
  const Mask valid = validate_candidates(points, static_map, parameters);
  Mask dynamic(candidates.size(), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) dynamic[chosen[i]] = valid[i];
  return dynamic;
}

/// One pass of the paper's section 3 over scans; owns the map that grows or shrinks with them.
class RaymovalPass {
 public:
  RaymovalPass(const RaymovalParameters& parameters, const SensorModel& sensor,
               const RunContext& context, const MakeCaster& make_caster)
      : parameters_(parameters),
        sensor_(sensor),
        context_(context),
        grid_(grid_for(sensor, parameters)),
        map_(parameters.voxel_size, parameters.permanent_erase),
        erase_rows_(rows_of_a_beam(sensor, grid_, parameters)),
        cast_image_(make_caster(grid_, {parameters.minimum_range, parameters.maximum_range})) {
    known_.remembers = true;
  }

  [[nodiscard]] StaticMap& map() { return map_; }

  /// Section 3 for one scan. @return 1 for each point found dynamic now (the online answer).
  Mask process(const PreparedScan& prepared) {
    cast(prepared);                                     // eqs 4-7
    find_references(prepared);                          // eqs 8-9
    const Mask candidates = find_candidates(prepared);  // eq. 11
    Mask dynamic;                                       // eqs 12-15
    Evidence evidence;                                  // Of what is seen through.
    side_by_side([&](StageTimes* times) { dynamic = validate(prepared, candidates, times); },
                 [&](StageTimes* times) { evidence = find_evidence(prepared, times); });
    erase(evidence);
    integrate(prepared, dynamic);
    return dynamic;
  }

  /// Finds the voxel of each point and projects it (eqs 1-3, 10).
  void prepare(Scan scan, PreparedScan& prepared) const {
    const StageScope timed(context_.times, "binning");
    prepared.scan = std::move(scan);
    find_voxels(prepared.scan, map_.occupied().inverse_voxel_size(), context_.threads,
                prepared.voxels);
    project(prepared.scan, grid_, parameters_.minimum_range, context_.threads, prepared.projected);
  }

 private:
  /// Voxels to erase.
  struct Evidence {
    std::vector<VoxelIndex> seen_through, without_return;
  };

  /// Two steps that only read the map: with several threads one is done beside the other, and they
  /// are timed as one stage.
  template <class Validate, class FindEvidence>
  void side_by_side(Validate&& validate_step, FindEvidence&& evidence_step) {
    const bool together = context_.threads > 1;
    const StageScope timed(together ? context_.times : nullptr, "validation and erase");
    StageTimes* times = together ? nullptr : context_.times;
    parallel_for(context_.threads, 2, 1, [&](std::size_t task) {
      if (task == 0) {
        validate_step(times);
      } else {
        evidence_step(times);
      }
    });
  }

  void cast(const PreparedScan& prepared) {
    const StageScope timed(context_.times, "raycasting");
    cast_image_(map_.occupied(), prepared.scan.T_world_sensor, context_.threads, first_hit_);
  }

  /// The map reference of both tests, where the scan has a return.
  void find_references(const PreparedScan& prepared) {
    const StageScope timed(context_.times, "classification");
    windowed_percentiles(
        first_hit_.range, prepared.projected.minimum_range, grid_, parameters_.neighbourhood,
        {parameters_.percentile, parameters_.erase_percentile}, context_.threads, references_);
    map_.look_up(prepared.voxels, context_.threads, known_);
  }

  /// Eq. 11; also points where the map was seen through before.
  Mask find_candidates(const PreparedScan& prepared) {
    const StageScope timed(context_.times, "classification");
    // In a map of all scans every point is its own first hit, and the answer comes at the end.
    if (parameters_.map_source == MapSource::kNaive) return Mask(prepared.scan.size(), 0);
    Mask candidates;
    if (parameters_.forward_test) {
      candidates = check_consistency(prepared.projected, references_.first,
                                     {parameters_.tau0, parameters_.tau1}, context_.threads);
    } else {
      candidates.assign(prepared.scan.size(), 0);
    }
    if (!parameters_.permanent_erase) return candidates;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      candidates[k] |= known_.states[k] == VoxelState::kErased ? 1 : 0;
    }
    return candidates;
  }

  Mask validate(const PreparedScan& prepared, const Mask& candidates, StageTimes* times) {
    if (!parameters_.validate || parameters_.map_source == MapSource::kNaive) return candidates;
    const StageScope timed(times, "validation");
    return validate_scan(prepared.scan, prepared.voxels, candidates, map_.occupied(), parameters_);
  }

  /// Both kinds of evidence are read off the same map before any of it is erased.
  Evidence find_evidence(const PreparedScan& prepared, StageTimes* times) {
    Evidence evidence;
    if (parameters_.erase) {
      const StageScope timed(times, "erase");
      evidence.seen_through = voxels_seen_through(prepared);
    }
    if (parameters_.no_return) {
      const StageScope timed(times, "no-return evidence");
      evidence.without_return = voxels_without_return(prepared);
    }
    return evidence;
  }

  void erase(const Evidence& evidence) {
    for (const VoxelIndex& voxel : evidence.seen_through) map_.erase(voxel);
    for (const VoxelIndex& voxel : evidence.without_return) map_.erase(voxel);
  }

  std::vector<VoxelIndex> voxels_seen_through(const PreparedScan& prepared) {
    std::vector<VoxelIndex> voxels;
    windowed_minimum(prepared.projected.minimum_range, grid_, parameters_.erase_azimuth_window,
                     erase_rows_, context_.threads, nearest_return_);
    for (const SeenThrough& through :
         find_seen_through(prepared.projected, nearest_return_, first_hit_, references_.second,
                           {parameters_.erase_tau0, parameters_.erase_tau1}, context_.threads)) {
      const float first_hit = first_hit_.range[static_cast<std::size_t>(through.bin)];
      const bool along_surface = through.nearest_return - first_hit <
                                 grazing_distance(first_hit_.ray(through.bin).direction.z(),
                                                  parameters_.erase_height * parameters_.voxel_size,
                                                  parameters_.erase_height_limit);
      if (along_surface) continue;
      const auto voxel = first_hit_.voxel(map_.occupied(), through.bin);
      if (voxel) voxels.push_back(*voxel);
    }
    drop_own_voxels(prepared, voxels);
    return voxels;
  }

  /// A ray may pass through the empty part of a voxel: one in which the scan itself has a point is
  /// not seen through.
  void drop_own_voxels(const PreparedScan& prepared, std::vector<VoxelIndex>& voxels) {
    if (voxels.empty()) return;
    const auto slot_of = [&](const VoxelIndex& voxel) {
      return map_.occupied().find_slot(OccupancyMap::brick_of(voxel));
    };
    std::vector<OccupancyMap::Slot> bricks;
    number_of_.resize(map_.occupied().brick_count(), 0);
    for (const VoxelIndex& voxel : voxels) {
      std::uint32_t& number = number_of_[slot_of(voxel)];
      if (number != 0) continue;
      bricks.push_back(slot_of(voxel));
      number = static_cast<std::uint32_t>(bricks.size());
    }
    std::vector<Brick> own(bricks.size());             // The scan's voxels in these bricks.
    OccupancyMap::Slot last = OccupancyMap::kNoBrick;  // Neighbours often share a brick.
    Brick* open = nullptr;
    for (std::size_t k = 0; k < known_.slots.size(); ++k) {
      const OccupancyMap::Slot slot = known_.slots[k];
      if (slot != last) {
        last = slot;
        const std::uint32_t number = slot == OccupancyMap::kNoBrick ? 0 : number_of_[slot];
        open = number == 0 ? nullptr : &own[number - 1];
      }
      if (open == nullptr) continue;
      const VoxelIndex& voxel = prepared.voxels[k];
      open->add(voxel.x(), voxel.y(), voxel.z());
    }
    std::erase_if(voxels, [&](const VoxelIndex& voxel) {
      return own[number_of_[slot_of(voxel)] - 1].contains(voxel.x(), voxel.y(), voxel.z());
    });
    for (const OccupancyMap::Slot slot : bricks) number_of_[slot] = 0;
  }

  std::vector<VoxelIndex> voxels_without_return(const PreparedScan& prepared) {
    std::vector<VoxelIndex> erased;
    windowed_minimum(prepared.projected.minimum_range, grid_, parameters_.no_return_azimuth_window,
                     parameters_.no_return_elevation_window, context_.threads, nearest_return_);
    std::vector<VoxelKey> voxels;
    for (const int bin :
         find_no_return(nearest_return_, first_hit_, grid_, sensor_, parameters_.no_return_range)) {
      const auto voxel = first_hit_.voxel(map_.occupied(), bin);
      if (voxel) voxels.push_back(voxel_key(*voxel));
    }
    // However many of its bins a scan misses, it is one witness.
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
    for (const VoxelKey voxel : voxels) {
      if (++scans_without_return_[voxel] >= parameters_.no_return_scans) {
        erased.push_back(voxel_index(voxel));
      }
    }
    return erased;
  }

  void integrate(const PreparedScan& prepared, const Mask& dynamic) {
    if (parameters_.map_source == MapSource::kNaive) return;
    const StageScope timed(context_.times, "integration");
    map_.integrate(prepared.voxels, known_, dynamic);
  }

  const RaymovalParameters& parameters_;
  const SensorModel& sensor_;
  const RunContext& context_;
  AngularGrid grid_;
  StaticMap map_;
  int erase_rows_;
  CastImage cast_image_;
  VoxelMap<int> scans_without_return_;
  // Of the present scan; kept for their memory.
  FirstHitImage first_hit_;
  WindowPercentiles references_;
  VoxelLookup known_;  ///< Of each point's voxel, before the scan changes the map.
  std::vector<std::uint32_t> number_of_;  ///< Of each brick that may be seen through; else 0.
  std::vector<float> nearest_return_;
};

class RaymovalRemover : public Remover {
 public:
  RaymovalRemover(const RaymovalParameters& parameters, const MakeCaster& make_caster)
      : parameters_(parameters), make_caster_(make_caster ? make_caster : sweep_caster) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    RaymovalPass pass(parameters_, scans.sensor(), context, make_caster_);
    if (parameters_.offline) {
      run_offline(pass, scans, sink, context);
    } else {
      run_online(pass, scans, sink, context);
    }
  }

 private:
  void run_online(RaymovalPass& pass, const ScanSource& scans, RemovalSink& sink,
                  const RunContext& context) {
    PreparedScan prepared;
    for_each_scan("raymoval", scans, context, [&](Scan scan) {
      const std::size_t index = scan.index;
      pass.prepare(std::move(scan), prepared);
      sink.accept(index, pass.process(prepared));
    });
  }

  void run_offline(RaymovalPass& pass, const ScanSource& scans, RemovalSink& sink,
                   const RunContext& context) {
    if (parameters_.map_source == MapSource::kNaive) collect_naive_map(pass, scans, context);
    PreparedScan prepared;
    const auto process = [&](Scan scan) {
      pass.prepare(std::move(scan), prepared);
      pass.process(prepared);
    };
    for_each_scan("raymoval", scans, context, process);
    if (parameters_.backward_pass) {
      for_each_scan("raymoval, backward", scans, context, process, ScanOrder::kBackward);
    }
    answer_from_map(pass.map(), scans, sink, context);
  }

  void collect_naive_map(RaymovalPass& pass, const ScanSource& scans, const RunContext& context) {
    for_each_scan("raymoval, naive map", scans, context, [&](const Scan& scan) {
      const StageScope timed(context.times, "integration");
      const std::vector<VoxelIndex> voxels = voxels_of(pass.map(), scan, context.threads);
      VoxelLookup known;
      pass.map().look_up(voxels, context.threads, known);
      pass.map().integrate(voxels, known, Mask(voxels.size(), 0));
    });
  }

  /// A point is dynamic iff its voxel is not in the final map and validation finds it to be one.
  void answer_from_map(const StaticMap& map, const ScanSource& scans, RemovalSink& sink,
                       const RunContext& context) {
    if (context.reasons != nullptr) context.reasons->explain(answer_reasons());
    RunContext own = context;  // Of one scan among others.
    own.threads = 1;
    if (context.threads > 1) own.times = nullptr;
    const auto answer = [&](const Scan& scan) {
      const std::vector<VoxelIndex> voxels = voxels_of(map, scan, own.threads);
      Mask removed = points_off_the_map(map, voxels, own);
      const Mask off_map = context.reasons != nullptr ? removed : Mask{};
      if (parameters_.validate) {
        const StageScope timed(own.times, "validation");
        removed = validate_scan(scan, voxels, removed, map.occupied(), parameters_);
      }
      sink.accept(scan.index, removed);
      if (context.reasons != nullptr) {
        context.reasons->accept(scan.index, reasons_for(map, voxels, off_map, removed));
      }
    };
    for_scans_at_once("raymoval, answers", "answer and validation", scans, context, answer);
  }

  // Codes of `answer_reasons`.
  static constexpr std::uint8_t kNeverContradicted = 0;
  static constexpr std::uint8_t kSeenThrough = 1;
  static constexpr std::uint8_t kInFrontOfMap = 2;
  static constexpr std::uint8_t kRestored = 3;

  static std::vector<std::string> answer_reasons() {
    return {"no scan contradicts its voxel, which stays in the map", "a scan saw through its voxel",
            "it stood in front of the map, so its voxel never entered it",
            "its voxel was contradicted, and validation found that it belongs to the static map"};
  }

  /// Why each point of a scan is kept or removed, see `answer_reasons`.
  std::vector<std::uint8_t> reasons_for(const StaticMap& map, const std::vector<VoxelIndex>& voxels,
                                        const Mask& off_map, const Mask& removed) const {
    std::vector<std::uint8_t> codes(voxels.size(), kNeverContradicted);
    for (std::size_t k = 0; k < codes.size(); ++k) {
      if (off_map[k] == 0) continue;
      // All voxels of a naive map were in it; what is not there now was erased.
      const bool erased = parameters_.map_source == MapSource::kNaive || map.was_erased(voxels[k]);
      codes[k] = removed[k] == 0 ? kRestored : erased ? kSeenThrough : kInFrontOfMap;
    }
    return codes;
  }

  static Mask points_off_the_map(const StaticMap& map, const std::vector<VoxelIndex>& voxels,
                                 const RunContext& context) {
    const StageScope timed(context.times, "answer");
    VoxelLookup known;
    map.look_up(voxels, context.threads, known);
    Mask off(voxels.size());
    std::transform(known.states.begin(), known.states.end(), off.begin(), [](VoxelState state) {
      return static_cast<std::uint8_t>(state == VoxelState::kOccupied ? 0 : 1);
    });
    return off;
  }

  static std::vector<VoxelIndex> voxels_of(const StaticMap& map, const Scan& scan, int threads) {
    std::vector<VoxelIndex> voxels;
    find_voxels(scan, map.occupied().inverse_voxel_size(), threads, voxels);
    return voxels;
  }

  RaymovalParameters parameters_;
  MakeCaster make_caster_;
};

}  // namespace

std::unique_ptr<Remover> make_raymoval(const RaymovalParameters& parameters,
                                       const MakeCaster& make_caster) {
  if (!parameters.offline && parameters.map_source == MapSource::kNaive) {
    throw ConfigurationError(
        "raymoval.map_source = naive needs all scans, which an online run (offline = false) does "
        "not have; use map_source = growing.");
  }
  return std::make_unique<RaymovalRemover>(parameters, make_caster);
}

}  // namespace raymoval
