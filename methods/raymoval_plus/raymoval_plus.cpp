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

namespace raymoval {
namespace {

/// Points of a scan in the world, with their heights above the ground.
struct WorldScan {
  Scan scan;
  std::vector<Eigen::Vector3d> points;
  std::vector<float> height;
};

class RaymovalPlusRemover : public Remover {
 public:
  explicit RaymovalPlusRemover(const RaymovalPlusParameters& parameters)
      : parameters_(parameters), terrain_(parameters), map_(parameters.voxel_size) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    if (parameters_.terrain) find_terrain(scans, context);
    collect_voxels(scans, context);
    gather_evidence(scans, context);
    decide(context);
    answer(scans, sink, context);
  }

 private:
  template <class Visit>
  void for_each_scan(const char* what, const ScanSource& scans, const RunContext& context,
                     Visit&& visit) {
    context.begin_pass(what, scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      context.check_cancelled();
      Scan scan = scans.load(i);
      const ScanScope timed(context.times, scan.index);
      visit(std::move(scan));
      context.advance();
    }
  }

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

  void answer(const ScanSource& scans, RemovalSink& sink, const RunContext& context) {
    for_each_scan("raymoval_plus, answers", scans, context, [&](Scan scan) {
      const WorldScan world = in_world(std::move(scan), context);
      const std::size_t count = world.points.size();
      std::vector<Evidence> verdict(count, Evidence::kStatic);
      {
        const StageScope timed(context.times, "answer");
        for (std::size_t k = 0; k < count; ++k) {
          if (is_ground(world.height[k])) continue;
          const std::uint32_t voxel = map_.find(voxel_key(map_.index_of(world.points[k])));
          verdict[k] = map_.evidence[voxel];
        }
      }
      if (parameters_.objects) judge_objects(world, verdict, context);
      if (parameters_.low_points && parameters_.terrain) judge_low_points(world, verdict, context);
      Mask removed(count);
      for (std::size_t k = 0; k < count; ++k) removed[k] = verdict[k] == Evidence::kDynamic ? 1 : 0;
      sink.accept(world.scan.index, removed);
    });
  }

  void judge_objects(const WorldScan& world, std::vector<Evidence>& verdict,
                     const RunContext& context) const {
    const StageScope timed(context.times, "objects");
    std::vector<std::size_t> chosen;
    std::vector<Eigen::Vector3f> points;
    std::vector<float> ranges;
    for (std::size_t k = 0; k < world.points.size(); ++k) {
      const float range = world.scan.points[k].norm();
      if (parameters_.terrain &&
          !(world.height[k] >= static_cast<float>(parameters_.object_height)))
        continue;
      if (range > parameters_.evidence_range_max) continue;
      chosen.push_back(k);
      points.push_back(world.scan.points[k]);
      ranges.push_back(range);
    }
    const std::vector<int> number =
        euclidean_clusters(points, ranges, static_cast<float>(parameters_.cluster_gap),
                           static_cast<float>(parameters_.cluster_growth));
    struct Cluster {
      int points = 0, dynamic = 0;
    };
    std::vector<Cluster> clusters;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const auto c = static_cast<std::size_t>(number[i]);
      if (c >= clusters.size()) clusters.resize(c + 1);
      ++clusters[c].points;
      if (verdict[chosen[i]] == Evidence::kDynamic) ++clusters[c].dynamic;
    }
    // Dynamic points that hang together keep their verdict even where they touch something large.
    std::vector<std::size_t> lone;
    std::vector<Eigen::Vector3f> lone_points;
    std::vector<float> lone_ranges;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const Cluster& cluster = clusters[static_cast<std::size_t>(number[i])];
      if (verdict[chosen[i]] != Evidence::kDynamic ||
          cluster.dynamic > parameters_.object_static_share * cluster.points) {
        continue;
      }
      lone.push_back(i);
      lone_points.push_back(points[i]);
      lone_ranges.push_back(ranges[i]);
    }
    const std::vector<int> group =
        euclidean_clusters(lone_points, lone_ranges, static_cast<float>(parameters_.cluster_gap),
                           static_cast<float>(parameters_.cluster_growth));
    std::vector<int> group_size;
    for (const int g : group) {
      if (static_cast<std::size_t>(g) >= group_size.size())
        group_size.resize(static_cast<std::size_t>(g) + 1);
      ++group_size[static_cast<std::size_t>(g)];
    }
    std::vector<std::uint8_t> spared(chosen.size(), 0);
    for (std::size_t k = 0; k < lone.size(); ++k) {
      spared[lone[k]] =
          group_size[static_cast<std::size_t>(group[k])] >= parameters_.group_points ? 1 : 0;
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (spared[i] != 0) continue;
      const Cluster& cluster = clusters[static_cast<std::size_t>(number[i])];
      const double share = static_cast<double>(cluster.dynamic) / cluster.points;
      if (share >= parameters_.object_dynamic_share &&
          cluster.points >= parameters_.object_points) {
        verdict[chosen[i]] = Evidence::kDynamic;
      } else if (share <= parameters_.object_static_share) {
        verdict[chosen[i]] = Evidence::kStatic;
      }
    }
  }

  void judge_low_points(const WorldScan& world, std::vector<Evidence>& verdict,
                        const RunContext& context) const {
    const StageScope timed(context.times, "low points");
    struct Standing {
      int dynamic = 0, fixed = 0;
    };
    VoxelMap<Standing> columns;
    const auto column = [&](const Eigen::Vector3d& point) {
      VoxelIndex index = map_.index_of(point);
      index.z() = 0;
      return index;
    };
    const auto low = static_cast<float>(parameters_.object_height);
    for (std::size_t k = 0; k < world.points.size(); ++k) {
      if (!(world.height[k] >= low) || world.height[k] >= 1.0F) continue;
      Standing& standing = columns[voxel_key(column(world.points[k]))];
      (verdict[k] == Evidence::kDynamic ? standing.dynamic : standing.fixed) += 1;
    }
    for (std::size_t k = 0; k < world.points.size(); ++k) {
      if (is_ground(world.height[k]) || world.height[k] >= low) continue;
      const VoxelIndex center = column(world.points[k]);
      Standing sum;
      for (int n = 0; n < 9; ++n) {
        const auto found =
            columns.find(voxel_key(center.x() + n % 3 - 1, center.y() + n / 3 - 1, 0));
        if (found == columns.end()) continue;
        sum.dynamic += found->second.dynamic;
        sum.fixed += found->second.fixed;
      }
      if (sum.dynamic > 0 && sum.dynamic >= 2 * sum.fixed) {
        verdict[k] = Evidence::kDynamic;
      } else if (sum.fixed > 0 && sum.fixed >= 2 * sum.dynamic) {
        verdict[k] = Evidence::kStatic;
      }
    }
  }

  RaymovalPlusParameters parameters_;
  Terrain terrain_;
  EvidenceMap map_;
  std::vector<Eigen::Vector3d> centroids_;
};

}  // namespace

std::unique_ptr<Remover> make_raymoval_plus(const RaymovalPlusParameters& parameters) {
  return std::make_unique<RaymovalPlusRemover>(parameters);
}

}  // namespace raymoval
