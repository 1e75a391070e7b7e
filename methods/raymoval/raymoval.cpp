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

namespace raymoval {
namespace {

AngularGrid grid_for(const SensorModel& sensor, const RaymovalParameters& parameters) {
  const double margin = parameters.elevation_margin * std::numbers::pi / 180.0;
  AngularGrid grid;
  grid.elevation_min = std::max(sensor.elevation_min - margin, -std::numbers::pi / 2.0);
  grid.elevation_max = std::min(sensor.elevation_max + margin, std::numbers::pi / 2.0);
  const auto bins_for = [](int wanted, double width, double step, int otherwise) {
    if (wanted > 0) return wanted;
    return step > 0.0 ? std::max(36, static_cast<int>(std::ceil(width / step))) : otherwise;
  };
  grid.azimuth_bins =
      bins_for(parameters.azimuth_bins, 2.0 * std::numbers::pi, sensor.azimuth_step, 720);
  grid.elevation_bins = bins_for(parameters.elevation_bins, grid.elevation_max - grid.elevation_min,
                                 sensor.elevation_step, 450);
  return grid;
}

/// Rows of the grid from one beam to the next, so that a window of that radius holds a return
/// wherever the surface goes on.
int rows_of_a_beam(const SensorModel& sensor, const AngularGrid& grid,
                   const RaymovalParameters& parameters) {
  if (parameters.erase_elevation_window >= 0) return parameters.erase_elevation_window;
  constexpr double kUnknownStep = 0.5 * std::numbers::pi / 180.0;
  const double step = sensor.elevation_step > 0.0 ? sensor.elevation_step : kUnknownStep;
  return std::clamp(static_cast<int>(std::ceil(step / grid.elevation_step())), 1, 100);
}

/// A scan with what every step needs of it.
struct PreparedScan {
  Scan scan;
  std::vector<VoxelIndex> voxels;  ///< Of each point, in the world lattice.
  VoxelSet own_voxels;             ///< Voxels in which the scan itself has a point.
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
               const RunContext& context)
      : parameters_(parameters),
        sensor_(sensor),
        context_(context),
        grid_(grid_for(sensor, parameters)),
        map_(parameters.voxel_size, parameters.permanent_erase),
        erase_rows_(rows_of_a_beam(sensor, grid_, parameters)),
        caster_(grid_, {parameters.minimum_range, parameters.maximum_range}) {}

  [[nodiscard]] StaticMap& map() { return map_; }

  /// Section 3 for one scan. @return 1 for each point found dynamic now (the online answer).
  Mask process(const PreparedScan& prepared) {
    const FirstHitImage first_hit = cast(prepared.scan.T_world_sensor);  // eqs 4-7
    const Mask candidates = find_candidates(prepared, first_hit);        // eqs 8-9, 11
    const Mask dynamic = validate(prepared, candidates);                 // eqs 12-15
    erase_seen_through(prepared, first_hit);
    erase_without_return(prepared, first_hit);
    integrate(prepared, dynamic);
    return dynamic;
  }

  /// Finds the voxel of each point and projects it (eqs 1-3, 10).
  [[nodiscard]] PreparedScan prepare(Scan scan) const {
    const StageScope timed(context_.times, "binning");
    PreparedScan prepared;
    prepared.voxels.resize(scan.size());
    parallel_for(context_.threads, scan.size(), 8192, [&](std::size_t k) {
      prepared.voxels[k] = map_.voxel_of(scan.T_world_sensor * scan.points[k].cast<double>());
    });
    prepared.own_voxels.reserve(scan.size() / 2);
    for (const VoxelIndex& voxel : prepared.voxels) prepared.own_voxels.insert(voxel_key(voxel));
    prepared.projected = project(scan, grid_, parameters_.minimum_range);
    prepared.scan = std::move(scan);
    return prepared;
  }

 private:
  FirstHitImage cast(const Pose& T_world_sensor) {
    const StageScope timed(context_.times, "raycasting");
    FirstHitImage image;
    caster_.cast(map_.occupied(), T_world_sensor, context_.threads, image);
    return image;
  }

  /// Eq. 11 on the map reference of eqs 8-9; also points where the map was seen through before.
  Mask find_candidates(const PreparedScan& prepared, const FirstHitImage& first_hit) {
    const StageScope timed(context_.times, "classification");
    Mask candidates(prepared.scan.size(), 0);
    // In a map of all scans every point is its own first hit, and the answer comes at the end.
    if (parameters_.map_source == MapSource::kNaive) return candidates;
    if (parameters_.forward_test) {
      const std::vector<float> reference =
          windowed_percentile(first_hit.range, grid_, parameters_.neighbourhood,
                              parameters_.percentile, context_.threads);
      candidates =
          check_consistency(prepared.projected, reference, {parameters_.tau0, parameters_.tau1});
    }
    if (!parameters_.permanent_erase) return candidates;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (map_.was_erased(prepared.voxels[k])) candidates[k] = 1;
    }
    return candidates;
  }

  Mask validate(const PreparedScan& prepared, const Mask& candidates) {
    if (!parameters_.validate || parameters_.map_source == MapSource::kNaive) return candidates;
    const StageScope timed(context_.times, "validation");
    return validate_scan(prepared.scan, prepared.voxels, candidates, map_.occupied(), parameters_);
  }

  /// A ray may pass through the empty part of a voxel: one in which the scan itself has a point is
  /// not seen through.
  void erase_seen_through(const PreparedScan& prepared, const FirstHitImage& first_hit) {
    if (!parameters_.erase) return;
    const StageScope timed(context_.times, "erase");
    const std::vector<float> reference =
        windowed_percentile(first_hit.range, grid_, parameters_.neighbourhood,
                            parameters_.erase_percentile, context_.threads);
    const std::vector<float> nearest_return =
        windowed_minimum(prepared.projected.minimum_range, grid_, parameters_.erase_azimuth_window,
                         erase_rows_, context_.threads);
    std::vector<VoxelIndex> seen_through;
    for (const int bin : find_seen_through(prepared.projected, nearest_return, first_hit, reference,
                                           {parameters_.erase_tau0, parameters_.erase_tau1})) {
      const auto at = static_cast<std::size_t>(bin);
      const Eigen::Vector3d direction =
          prepared.scan.T_world_sensor.linear() * grid_.direction(bin);
      const bool along_surface =
          nearest_return[at] - first_hit.range[at] <
          grazing_distance(direction.z(), parameters_.erase_height * parameters_.voxel_size,
                           parameters_.erase_height_limit);
      if (along_surface) continue;
      const auto voxel = first_hit.voxel(map_.occupied(), bin);
      if (!voxel) continue;
      if (prepared.own_voxels.contains(voxel_key(*voxel))) continue;
      seen_through.push_back(*voxel);
    }
    for (const VoxelIndex& voxel : seen_through) map_.erase(voxel);
  }

  void erase_without_return(const PreparedScan& prepared, const FirstHitImage& first_hit) {
    if (!parameters_.no_return) return;
    const StageScope timed(context_.times, "no-return evidence");
    const std::vector<float> nearest_return = windowed_minimum(
        prepared.projected.minimum_range, grid_, parameters_.no_return_azimuth_window,
        parameters_.no_return_elevation_window, context_.threads);
    std::vector<VoxelKey> voxels;
    for (const int bin :
         find_no_return(nearest_return, first_hit, grid_, sensor_, parameters_.no_return_range)) {
      const auto voxel = first_hit.voxel(map_.occupied(), bin);
      if (voxel) voxels.push_back(voxel_key(*voxel));
    }
    // However many of its bins a scan misses, it is one witness.
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
    for (const VoxelKey voxel : voxels) {
      if (++scans_without_return_[voxel] >= parameters_.no_return_scans) {
        map_.erase(voxel_index(voxel));
      }
    }
  }

  void integrate(const PreparedScan& prepared, const Mask& dynamic) {
    if (parameters_.map_source == MapSource::kNaive) return;
    const StageScope timed(context_.times, "integration");
    for (std::size_t k = 0; k < dynamic.size(); ++k) {
      if (dynamic[k] == 0) map_.integrate(prepared.voxels[k]);
    }
  }

  const RaymovalParameters& parameters_;
  const SensorModel& sensor_;
  const RunContext& context_;
  AngularGrid grid_;
  StaticMap map_;
  int erase_rows_;
  FirstHitCaster caster_;
  VoxelMap<int> scans_without_return_;
};

class RaymovalRemover : public Remover {
 public:
  explicit RaymovalRemover(const RaymovalParameters& parameters) : parameters_(parameters) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    RaymovalPass pass(parameters_, scans.sensor(), context);
    if (parameters_.offline) {
      run_offline(pass, scans, sink, context);
    } else {
      run_online(pass, scans, sink, context);
    }
  }

 private:
  /// Calls `visit` with each scan, timed and cancellable.
  template <class Visit>
  void for_each_scan(const char* what, const ScanSource& scans, const RunContext& context,
                     bool backward, Visit&& visit) {
    context.begin_pass(what, scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      context.check_cancelled();
      Scan scan = scans.load(backward ? scans.size() - 1 - i : i);
      const ScanScope timed(context.times, scan.index);
      visit(std::move(scan));
      context.advance();
    }
  }

  void run_online(RaymovalPass& pass, const ScanSource& scans, RemovalSink& sink,
                  const RunContext& context) {
    for_each_scan("raymoval", scans, context, false, [&](Scan scan) {
      const std::size_t index = scan.index;
      sink.accept(index, pass.process(pass.prepare(std::move(scan))));
    });
  }

  void run_offline(RaymovalPass& pass, const ScanSource& scans, RemovalSink& sink,
                   const RunContext& context) {
    if (parameters_.map_source == MapSource::kNaive) collect_naive_map(pass, scans, context);
    for_each_scan("raymoval", scans, context, false, [&](Scan scan) {
      const PreparedScan prepared = pass.prepare(std::move(scan));
      pass.process(prepared);
    });
    if (parameters_.backward_pass) {
      for_each_scan("raymoval, backward", scans, context, true,
                    [&](Scan scan) { pass.process(pass.prepare(std::move(scan))); });
    }
    answer_from_map(pass.map(), scans, sink, context);
  }

  void collect_naive_map(RaymovalPass& pass, const ScanSource& scans, const RunContext& context) {
    for_each_scan("raymoval, naive map", scans, context, false, [&](const Scan& scan) {
      const StageScope timed(context.times, "integration");
      const std::vector<VoxelIndex> voxels = voxels_of(pass.map(), scan, context.threads);
      for (const VoxelIndex& voxel : voxels) pass.map().integrate(voxel);
    });
  }

  /// A point is dynamic iff its voxel is not in the final map and validation finds it to be one.
  void answer_from_map(const StaticMap& map, const ScanSource& scans, RemovalSink& sink,
                       const RunContext& context) {
    for_each_scan("raymoval, answers", scans, context, false, [&](const Scan& scan) {
      const std::vector<VoxelIndex> voxels = voxels_of(map, scan, context.threads);
      Mask removed = points_off_the_map(map, voxels, context);
      if (parameters_.validate) {
        const StageScope timed(context.times, "validation");
        removed = validate_scan(scan, voxels, removed, map.occupied(), parameters_);
      }
      sink.accept(scan.index, removed);
    });
  }

  static Mask points_off_the_map(const StaticMap& map, const std::vector<VoxelIndex>& voxels,
                                 const RunContext& context) {
    const StageScope timed(context.times, "answer");
    Mask off(voxels.size(), 0);
    parallel_for(context.threads, voxels.size(), 8192,
                 [&](std::size_t k) { off[k] = map.occupied().contains(voxels[k]) ? 0 : 1; });
    return off;
  }

  static std::vector<VoxelIndex> voxels_of(const StaticMap& map, const Scan& scan, int threads) {
    std::vector<VoxelIndex> voxels(scan.size());
    parallel_for(threads, scan.size(), 8192, [&](std::size_t k) {
      voxels[k] = map.voxel_of(scan.T_world_sensor * scan.points[k].cast<double>());
    });
    return voxels;
  }

  RaymovalParameters parameters_;
};

}  // namespace

std::unique_ptr<Remover> make_raymoval(const RaymovalParameters& parameters) {
  if (!parameters.offline && parameters.map_source == MapSource::kNaive) {
    throw ConfigurationError(
        "raymoval.map_source = naive needs all scans, which an online run (offline = false) does "
        "not have; use map_source = growing.");
  }
  return std::make_unique<RaymovalRemover>(parameters);
}

}  // namespace raymoval
