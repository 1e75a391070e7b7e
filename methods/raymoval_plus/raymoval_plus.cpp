// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/parallel.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/objects.h"
#include "methods/raymoval_plus/range_image.h"
#include "methods/raymoval_plus/terrain.h"
#include "methods/raymoval_plus/verdicts.h"
#include "methods/scan_passes.h"

namespace raymoval {
namespace {

class RaymovalPlusRemover : public Remover {
 public:
  explicit RaymovalPlusRemover(const RaymovalPlusParameters& parameters)
      : parameters_(parameters), terrain_(parameters), map_(parameters.voxel_size) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    if (parameters_.terrain) find_terrain(scans, context);
    collect_voxels(scans, context);
    gather_evidence(scans, context);
    decide(context);
    if (parameters_.objects && parameters_.tracks) follow_objects(scans, context);
    answer(scans, sink, context);
  }

 private:
  void find_terrain(const ScanSource& scans, const RunContext& context) {
    for_each_scan("raymoval_plus, terrain", scans, context, [&](const Scan& scan) {
      const StageScope timed(context.times, "terrain");
      for (const Eigen::Vector3f& point : scan.points) {
        terrain_.add(scan.T_world_sensor * point.cast<double>());
      }
    });
    const StageScope timed(context.times, "terrain");
    terrain_.finish(context.threads);
  }

  WorldScan in_world(Scan scan, const RunContext& context) const {
    WorldScan world;
    world.points.resize(scan.size());
    world.height.resize(scan.size());
    parallel_for(context.threads, scan.size(), 8192, [&](std::size_t k) {
      world.points[k] = scan.T_world_sensor * scan.points[k].cast<double>();
      world.height[k] = terrain_.height(world.points[k]);
    });
    world.scan = std::move(scan);
    return world;
  }
  [[nodiscard]] bool is_ground(float height) const {
    return parameters_.terrain && height < static_cast<float>(parameters_.ground_height);
  }

  void collect_voxels(const ScanSource& scans, const RunContext& context) {
    for_each_scan("raymoval_plus, voxels", scans, context, [&](Scan scan) {
      const StageScope timed(context.times, "voxels");
      const WorldScan world = in_world(std::move(scan), context);
      for (std::size_t k = 0; k < world.points.size(); ++k) {
        if (!is_ground(world.height[k])) map_.add(world.points[k]);
      }
    });
    const StageScope timed(context.times, "voxels");
    map_.freeze();
    centroids_.resize(map_.size());
    for (std::size_t v = 0; v < map_.size(); ++v) centroids_[v] = map_.centroid(v);
  }

  void gather_evidence(const ScanSource& scans, const RunContext& context) {
    RangeImage image(scans.sensor(), parameters_);
    for_each_scan("raymoval_plus, evidence", scans, context, [&](const Scan& scan) {
      {
        const StageScope timed(context.times, "range image");
        image.fill(scan);
      }
      const StageScope timed(context.times, "evidence");
      const Pose T_sensor_world = scan.T_world_sensor.inverse(Eigen::Isometry);
      const Eigen::Vector3d center = scan.T_world_sensor.translation();
      const double range = parameters_.evidence_range_max;
      map_.for_tiles_near(center, range, [&](std::uint32_t first, std::uint32_t last) {
        parallel_for(context.threads, last - first, 2048, [&](std::size_t i) {
          const std::size_t voxel = first + i;
          const double distance = (centroids_[voxel] - center).norm();
          if (distance > range || distance < parameters_.evidence_range_min) return;
          const Seen seen = image.test((T_sensor_world * centroids_[voxel]).cast<float>());
          if (seen == Seen::kAgree) {
            count_up(map_.agree_scans[voxel]);
            map_.trailing_free[voxel] = 0;
          }
          if (seen == Seen::kFree) {
            count_up(map_.free_scans[voxel]);
            if (distance <= parameters_.run_range) {
              count_up(map_.trailing_free[voxel]);
              if (map_.agree_scans[voxel] == 0) count_up(map_.leading_free[voxel]);
            }
          }
        });
      });
    });
  }
  static void count_up(std::uint16_t& count) {
    if (count < 0xFFFFU) ++count;
  }

  void decide(const RunContext& context) {
    const StageScope timed(context.times, "decision");
    decide_voxels(map_, parameters_);
    const auto before = map_.evidence;  // DEBUG
    vote(map_, parameters_, context.threads);
    if (const char* path = std::getenv("PLUS_DUMP")) {  // DEBUG
      FILE* f = std::fopen(path, "wb");
      for (std::size_t v = 0; v < map_.size(); ++v) {
        const std::uint64_t row[5] = {map_.key(v), map_.free_scans[v], map_.agree_scans[v],
                                      (std::uint64_t)before[v], (std::uint64_t)map_.evidence[v]};
        std::fwrite(row, 8, 5, f);
      }
      std::fclose(f);
    }
  }

  /// The scan with the verdicts of its voxels.
  WorldScan judged(Scan scan, const RunContext& context) const {
    WorldScan world = in_world(std::move(scan), context);
    const StageScope timed(context.times, "answer");
    world.voxel.resize(world.points.size());
    world.verdict.resize(world.points.size());
    parallel_for(context.threads, world.points.size(), 8192, [&](std::size_t k) {
      const bool ground = is_ground(world.height[k]);
      const std::uint32_t voxel =
          ground ? EvidenceMap::kNone : map_.find(voxel_key(map_.index_of(world.points[k])));
      world.voxel[k] = voxel;
      world.verdict[k] = ground ? Evidence::kStatic : map_.evidence[voxel];
    });
    return world;
  }

  void follow_objects(const ScanSource& scans, const RunContext& context) {
    std::vector<std::vector<ObjectSummary>> found(scans.size());
    for_each_scan("raymoval_plus, tracks", scans, context, [&](Scan scan) {
      const WorldScan world = judged(std::move(scan), context);
      const StageScope timed(context.times, "objects");
      found[world.scan.index] =
          summaries(find_objects(world, parameters_), world, map_, parameters_);
    });
    const StageScope timed(context.times, "tracks");
    marks_ = objects_on_tracks(found, parameters_);
  }

  void answer(const ScanSource& scans, RemovalSink& sink, const RunContext& context) {
    static const std::vector<std::uint8_t> kNoMarks;
    for_each_scan("raymoval_plus, answers", scans, context, [&](Scan scan) {
      WorldScan world = judged(std::move(scan), context);
      if (parameters_.objects) {
        const StageScope timed(context.times, "objects");
        const ScanObjects objects = find_objects(world, parameters_);
        judge_objects(objects, marks_.empty() ? kNoMarks : marks_[world.scan.index], parameters_,
                      world);
      }
      if (parameters_.low_points && parameters_.terrain) {
        const StageScope timed(context.times, "low points");
        judge_low_points(parameters_, world);
      }
      Mask removed(world.points.size());
      for (std::size_t k = 0; k < removed.size(); ++k) {
        removed[k] = world.verdict[k] == Evidence::kDynamic ? 1 : 0;
      }
      sink.accept(world.scan.index, removed);
    });
  }

  RaymovalPlusParameters parameters_;
  Terrain terrain_;
  EvidenceMap map_;
  std::vector<Eigen::Vector3d> centroids_;
  std::vector<std::vector<std::uint8_t>> marks_;  ///< By scan and cluster: moved at some time.
};

}  // namespace

std::unique_ptr<Remover> make_raymoval_plus(const RaymovalPlusParameters& parameters) {
  return std::make_unique<RaymovalPlusRemover>(parameters);
}

}  // namespace raymoval
