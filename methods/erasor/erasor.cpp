// SPDX-License-Identifier: MIT
// "ERASOR: Egocentric Ratio of Pseudo Occupancy-based Dynamic Object Removal for Static 3D Point
// Cloud Map Building", RA-L 2021, and the order of operations of its public program.
#include "methods/erasor/erasor.h"

#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/text.h"
#include "methods/common/answers.h"
#include "methods/common/remover_from.h"
#include "methods/common/side_by_side.h"
#include "methods/common/thinned_points.h"
#include "methods/erasor/body_frame.h"
#include "methods/erasor/naive_map.h"
#include "methods/erasor/polar_bins.h"

namespace raymoval::erasor_method {
namespace {

/// The points of a query by bin, after thinning.
struct QueryBins {
  std::vector<BinExtent> extents;
  std::vector<int> bin_of_point;  ///< The bin of each raw point's thinned point, or -1.
};

/// The map's voxels in the volume of interest by bin.
struct MapBins {
  struct Member {
    VoxelNumber voxel;
    int bin;
    double height;
  };
  std::vector<BinExtent> extents;
  std::vector<std::vector<Member>> members;  ///< Chunk by chunk, in order.
};

/// Voxel and world point of each point of a scan.
struct LocatedPoints {
  std::vector<VoxelKey> keys;
  std::vector<Eigen::Vector3d> world;
};

class ErasorRun {
 public:
  ErasorRun(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        context_(context),
        bins_(parameters),
        actions_(bins_.size()) {}

  /// The map of all scans.
  NaiveMap collect_naive_map() {
    NaiveMapBuilder builder;
    LocatedPoints known, next;
    const auto add_known = [&](const RunContext& context) {
      const StageScope timed(context.times, "naive map");
      builder.add(known.keys, known.world);
    };
    for_each_scan("erasor, naive map", scans_, context_, [&](const Scan& scan) {
      // Scans are added in turn, each in parallel with the search for the voxels of the next scan.
      side_by_side(context_, "naive map", add_known, [&](const RunContext& context) {
        const StageScope timed(context.times, "naive map");
        locate(scan, next);
      });
      std::swap(known, next);
    });
    add_known(context_);
    const StageScope timed(context_.times, "naive map");
    return builder.finish();
  }

  /// Compares every n-th scan with the map, from which earlier queries removed voxels.
  void process_queries(NaiveMap& map) {
    const auto interval = static_cast<std::size_t>(parameters_.removal_interval);
    const std::size_t first =
        parameters_.phase < 0 ? interval - 1 : static_cast<std::size_t>(parameters_.phase);
    for_each_scan("erasor, queries", scans_, every_nth_scan(first, scans_.size(), interval),
                  context_, [&](const Scan& scan) { process(scan, map); });
  }

  /// A point is dynamic iff its voxel was removed from the map.
  void answer(const NaiveMap& map, RemovalSink& sink) {
    answer_scans("erasor, answers", scans_, sink, context_, [&](const Scan& scan) {
      return mask_by_voxel(scan, parameters_.map_voxel_size,
                           [&](const VoxelIndex& voxel) { return map.is_out(voxel_key(voxel)); });
    });
  }

 private:
  void process(const Scan& scan, NaiveMap& map) {
    QueryBins query;
    MapBins around;
    T_body_sensor_ = body_frame(scan.T_world_sensor, map, parameters_);
    side_by_side(
        context_, "query bins and map bins",
        [&](const RunContext& context) { query = describe(scan, context); },  // R-POD of the scan
        [&](const RunContext& context) {                                      // R-POD of the map
          around = describe(map, scan.T_world_sensor, context);
        });
    for (std::size_t b = 0; b < bins_.size(); ++b) {  // Scan ratio test
      const BinFinding finding = compare_extents(around.extents[b], query.extents[b], parameters_);
      actions_[b] = action_for(finding, around.extents[b], parameters_);
    }
    remove_above_ground(around, scan.T_world_sensor, map);  // R-GPF
    reinsert(scan, query, map);
  }

  /// World point and map voxel of each point of `scan`; none for points of the ego vehicle.
  void locate(const Scan& scan, LocatedPoints& points) const {
    points.keys.resize(scan.size());
    points.world.resize(scan.size());
    const double inverse = 1.0 / parameters_.map_voxel_size;
    parallel_for(context_.threads, scan.size(), 8192, [&](std::size_t k) {
      const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
      points.world[k] = world;
      points.keys[k] = is_ego_vehicle(scan.points[k], scan.T_world_sensor, parameters_)
                           ? NaiveMapBuilder::kNoVoxel
                           : voxel_key(voxel_index(world, inverse));
    });
  }

  [[nodiscard]] Eigen::Vector3d body_of(const Eigen::Vector3d& sensor_point) const {
    return T_body_sensor_ * sensor_point;
  }

  /// Thins the scan in the sensor frame and sorts the thinned points into bins.
  [[nodiscard]] QueryBins describe(const Scan& scan, const RunContext& context) const {
    const StageScope timed(context.times, "query bins");
    QueryBins query;
    query.extents.resize(bins_.size());
    query.bin_of_point.assign(scan.size(), -1);
    ThinnedPoints thinned(parameters_.query_voxel_size);
    std::vector<int> slot_of_point(scan.size(), -1);  // -1: a point of the ego vehicle.
    for (std::size_t k = 0; k < scan.size(); ++k) {
      if (is_ego_vehicle(scan.points[k], scan.T_world_sensor, parameters_)) continue;
      slot_of_point[k] = static_cast<int>(thinned.add(scan.points[k].cast<double>()));
    }
    std::vector<int> bin_of_slot(thinned.size());
    for (std::size_t s = 0; s < thinned.size(); ++s) {
      const Eigen::Vector3d body = body_of(thinned.centroid(s));
      const int bin = bin_of_slot[s] = bins_.bin_of(body);
      if (bin >= 0) query.extents[static_cast<std::size_t>(bin)].add(body.z());
    }
    for (std::size_t k = 0; k < scan.size(); ++k) {
      if (slot_of_point[k] < 0) continue;
      query.bin_of_point[k] = bin_of_slot[static_cast<std::size_t>(slot_of_point[k])];
    }
    return query;
  }

  /// Sorts the voxels that are in the map within the disc around the sensor into bins.
  [[nodiscard]] MapBins describe(const NaiveMap& map, const Pose& T_world_sensor,
                                 const RunContext& context) const {
    const StageScope timed(context.times, "map bins");
    const Eigen::Vector3d centre = T_world_sensor.translation();
    const std::vector<NaiveMap::Tile> tiles =
        map.tiles_around(centre.x(), centre.y(), parameters_.maximum_range);
    constexpr std::size_t kTilesAChunk = 16;
    MapBins around;
    around.members.resize(tiles.size() / kTilesAChunk + 1);
    parallel_chunks(
        context.threads, tiles.size(), kTilesAChunk, [&](std::size_t begin, std::size_t end) {
          for (std::size_t t = begin; t < end; ++t) {
            collect(map, tiles[t], T_world_sensor, around.members[begin / kTilesAChunk]);
          }
        });
    around.extents.resize(bins_.size());
    for (const auto& chunk : around.members) {
      for (const MapBins::Member& member : chunk) {
        around.extents[static_cast<std::size_t>(member.bin)].add(member.height);
      }
    }
    return around;
  }

  void collect(const NaiveMap& map, const NaiveMap::Tile& tile, const Pose& T_world_sensor,
               std::vector<MapBins::Member>& members) const {
    const Pose T_sensor_world = T_world_sensor.inverse();
    const double square_range = parameters_.maximum_range * parameters_.maximum_range;
    for (VoxelNumber voxel = tile.begin; voxel < tile.end; ++voxel) {
      if (!map.is_in(voxel)) continue;
      const Eigen::Vector3d from_centre = map.point(voxel) - T_world_sensor.translation();
      if (!(from_centre.head<2>().squaredNorm() < square_range)) continue;
      const Eigen::Vector3d body = body_of(T_sensor_world * map.point(voxel));
      const int bin = bins_.bin_of(body);
      if (bin >= 0) members.push_back({voxel, bin, body.z()});
    }
  }

  /// Removes map voxels above the ground from the bins in which the map is higher.
  void remove_above_ground(const MapBins& around, const Pose& T_world_sensor, NaiveMap& map) const {
    const StageScope timed(context_.times, "ground fit");
    std::vector<std::vector<VoxelNumber>> chosen;
    std::vector<int> place(bins_.size(), -1);
    for (std::size_t b = 0; b < bins_.size(); ++b) {
      if (!actions_[b].remove) continue;
      place[b] = static_cast<int>(chosen.size());
      chosen.emplace_back();
    }
    for (const auto& chunk : around.members) {
      for (const MapBins::Member& member : chunk) {
        const int at = place[static_cast<std::size_t>(member.bin)];
        if (at >= 0) chosen[static_cast<std::size_t>(at)].push_back(member.voxel);
      }
    }
    std::vector<Mask> ground(chosen.size());
    const Pose T_sensor_world = T_world_sensor.inverse();
    parallel_for(context_.threads, chosen.size(), 8, [&](std::size_t c) {
      std::vector<Eigen::Vector3d> points;
      for (const VoxelNumber voxel : chosen[c]) {
        points.push_back(body_of(T_sensor_world * map.point(voxel)));
      }
      ground[c] = find_ground(points, parameters_);
    });
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      for (std::size_t i = 0; i < chosen[c].size(); ++i) {
        if (ground[c][i] == 0) map.take_out(chosen[c][i]);
      }
    }
  }

  /// Puts back the voxels with query points in bins that reinsert them. It runs after all removals,
  /// because a query voxel may be in two bins.
  void reinsert(const Scan& scan, const QueryBins& query, NaiveMap& map) const {
    const StageScope timed(context_.times, "reinsertion");
    const double inverse = 1.0 / parameters_.map_voxel_size;
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const int bin = query.bin_of_point[k];
      if (bin < 0 || !actions_[static_cast<std::size_t>(bin)].reinsert) continue;
      const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
      map.put_back(voxel_key(voxel_index(world, inverse)), world);
    }
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  const RunContext& context_;
  PolarBins bins_;
  Pose T_body_sensor_ = Pose::Identity();  ///< Of the query that is processed.
  std::vector<BinAction> actions_;
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  Parameters of_sensor = parameters;
  of_sensor.minimum_points = minimum_points_of(scans.sensor(), parameters);
  ErasorRun erasor(of_sensor, scans, context);
  NaiveMap map = erasor.collect_naive_map();
  erasor.process_queries(map);
  erasor.answer(map, sink);
}

}  // namespace

std::unique_ptr<Remover> make_erasor(const Parameters& parameters) {
  if (!(parameters.minimum_height < parameters.maximum_height)) {
    throw ConfigurationError(
        "erasor.min_h = " + number_text(parameters.minimum_height) +
        " is not below erasor.max_h = " + number_text(parameters.maximum_height) +
        ", so no point would be tested; lower min_h or raise max_h.");
  }
  if (!(parameters.minimum_range < parameters.maximum_range)) {
    throw ConfigurationError(
        "erasor.min_range = " + number_text(parameters.minimum_range) +
        " is not below erasor.max_range = " + number_text(parameters.maximum_range) +
        ", so no point would be tested; raise max_range.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::erasor_method
