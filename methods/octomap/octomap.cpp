// SPDX-License-Identifier: MIT
#include "methods/octomap/octomap.h"

#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "core/scan/mask_store.h"
#include "core/text.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/octomap/occupancy_map.h"
#include "methods/octomap/point_filters.h"

namespace raymoval::octomap_method {
namespace {

using Points = std::vector<octomap::point3d>;

/// One run: the cells with points, a map of all scans, then a verdict on each point from the map.
class OctomapRun {
 public:
  OctomapRun(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        context_(context),
        map_(parameters),
        ground_(scans.size()) {
    if (scans.size() == 0) return;
    // Rounded to whole cells, so that the tree's lattice is the world's.
    const Eigen::Vector3d first = scans.pose(0).translation() / parameters.resolution;
    centre_ = first.array().round().matrix() * parameters.resolution;
  }

  void collect_cells() {
    for_each_scan("octomap, cells", scans_, context_, [this](const Scan& scan) {
      const Points points = in_tree_frame(scan);
      const StageScope timed(context_.times, "cells");
      for (const octomap::point3d& point : points) {
        if (const auto cell = map_.cell_of(point)) map_.keep(*cell);
      }
    });
  }

  void build_map() {
    for_each_scan("octomap", scans_, context_, [this](const Scan& scan) {
      const Points points = in_tree_frame(scan);
      const std::vector<PointRole> roles = roles_of(scan.index, points);
      map_.insert(points, roles, rounded(scan.T_world_sensor.translation() - centre_), context_);
    });
  }

  void answer(RemovalSink& sink) {
    for_each_scan("octomap, answers", scans_, context_, [&](const Scan& scan) {
      const Points points = in_tree_frame(scan);
      const Mask ground = ground_.get(scan.index);
      Mask mask(points.size(), 0);
      std::vector<float> evidence(points.size());
      {
        const StageScope timed(context_.times, "answer");
        parallel_for(context_.threads, points.size(), 8192, [&](std::size_t k) {
          const bool is_ground = !ground.empty() && ground[k] != 0;
          const Verdict verdict = is_ground ? Verdict{false, 0.0F} : verdict_of(points[k]);
          mask[k] = verdict.removed ? 1 : 0;
          evidence[k] = verdict.free;
        });
      }
      sink.accept(scan.index, mask);
      if (context_.evidence != nullptr) context_.evidence->accept(scan.index, evidence);
    });
    warn_of_points_outside();
  }

 private:
  struct Verdict {
    bool removed;
    float free;  ///< The probability that the point's cell is free; one half if it is unknown.
  };

  [[nodiscard]] octomap::point3d rounded(const Eigen::Vector3d& point) const {
    return {static_cast<float>(point.x()), static_cast<float>(point.y()),
            static_cast<float>(point.z())};
  }

  /// World points relative to the tree's centre; computed in double, rounded once to float.
  [[nodiscard]] Points in_tree_frame(const Scan& scan) const {
    const StageScope timed(context_.times, "transform");
    Points points(scan.size());
    const Eigen::Matrix3d rotation = scan.T_world_sensor.linear();
    const Eigen::Vector3d translation = scan.T_world_sensor.translation() - centre_;
    parallel_for(context_.threads, scan.size(), 8192, [&](std::size_t k) {
      points[k] = rounded(rotation * scan.points[k].cast<double>() + translation);
    });
    return points;
  }

  std::vector<PointRole> roles_of(std::size_t scan, const Points& points) {
    std::vector<PointRole> roles(points.size(), PointRole::kSurface);
    if (parameters_.noise) {
      const StageScope timed(context_.times, "noise filter");
      const Mask noise = find_noise(points, parameters_, context_.threads);
      for (std::size_t k = 0; k < noise.size(); ++k) {
        if (noise[k] != 0) roles[k] = PointRole::kNoise;
      }
    }
    if (parameters_.ground) mark_ground(scan, points, roles);
    return roles;
  }

  /// The plane is fitted to the points that are not noise.
  void mark_ground(std::size_t scan, const Points& points, std::vector<PointRole>& roles) {
    const StageScope timed(context_.times, "ground plane");
    Points candidates;
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (roles[k] != PointRole::kSurface) continue;
      candidates.push_back(points[k]);
      chosen.push_back(k);
    }
    const Mask on_plane = find_ground(candidates, parameters_);
    Mask ground(points.size(), 0);
    for (std::size_t k = 0; k < on_plane.size(); ++k) {
      if (on_plane[k] == 0) continue;
      roles[chosen[k]] = PointRole::kGround;
      ground[chosen[k]] = 1;
    }
    ground_.set(scan, ground);
  }

  Verdict verdict_of(const octomap::point3d& point) {
    const auto cell = map_.cell_of(point);
    if (!cell) {
      ++outside_;
      return {false, 0.5F};
    }
    const octomap::OcTreeNode* node = map_.tree().search(*cell);
    if (node == nullptr) return {parameters_.remove_unknown, 0.5F};
    return {!map_.tree().isNodeOccupied(node), static_cast<float>(1.0 - node->getOccupancy())};
  }

  void warn_of_points_outside() const {
    if (outside_ == 0 || context_.progress == nullptr) return;
    context_.progress->say("octomap: " + grouped_text(outside_) + " points lie more than " +
                           fixed_text(OccupancyMap::kReach * parameters_.resolution, 1) +
                           " m from the first scan, outside the tree, and are kept without a "
                           "verdict; use a larger resolution, or fewer scans.");
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  const RunContext& context_;
  OccupancyMap map_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< The tree's centre in the world, metres.
  MaskStore ground_;  ///< Points on the ground, which are kept for any state of their leaf.
  std::atomic<std::uint64_t> outside_{0};
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  OctomapRun octomap_run(parameters, scans, context);
  octomap_run.collect_cells();
  octomap_run.build_map();
  octomap_run.answer(sink);
}

}  // namespace

std::unique_ptr<Remover> make_octomap(const Parameters& parameters) {
  if (parameters.maximum_range == 0.0) {
    throw ConfigurationError(
        "octomap.maximum_range = 0 leaves no beam; give a range in metres, or -1 for unlimited.");
  }
  // Without PCL, this throws before anything runs.
  if (parameters.ground && !kHasPcl) (void)find_ground({}, parameters);
  return remover_from(parameters, run);
}

}  // namespace raymoval::octomap_method
