// SPDX-License-Identifier: MIT
#include "methods/octomap/octomap.h"

#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "core/scan/mask_store.h"
#include "core/text.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/common/side_by_side.h"
#include "methods/octomap/occupancy_tree.h"
#include "methods/octomap/point_filters.h"
#include "methods/octomap/scan_cells.h"

namespace raymoval::octomap_method {
namespace {

/// One run: the cells that matter, a map of all scans, then an answer for each point from the map.
class OctomapRun {
 public:
  OctomapRun(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        context_(context),
        lattice_(parameters.resolution),
        cells_(parameters, context),
        known_cells_(parameters, context),
        map_(parameters),
        kept_(scans.size()),
        dropped_(scans.size()) {
    if (scans.size() == 0) return;
    // Rounded to whole cells, so that the tree's lattice is the world's.
    const Eigen::Vector3d first = scans.pose(0).translation() / parameters.resolution;
    centre_ = first.array().round().matrix() * parameters.resolution;
  }

  /// Only cells that hold a point are ever asked for, and no cell depends on another: the map is
  /// kept to those. Free space without any point is most of a map.
  void collect_cells() {
    for_each_scan("octomap, cells", scans_, context_, [this](const Scan& scan) {
      const std::vector<octomap::point3d> points = in_tree_frame(scan);
      const StageScope timed(context_.times, "cells");
      for (const octomap::point3d& point : points) {
        if (const std::optional<CellCode> cell = lattice_.cell_of(point)) wanted_.occupy(*cell);
      }
    });
  }

  /// With several threads the map takes a scan in beside the search for the next one's cells.
  void build_map() {
    const auto take_in = [this](const RunContext& context) {
      const StageScope timed(context.times, "map update");
      map_.update(known_cells_.parts(), &wanted_);
      known_cells_.clear();
    };
    for_each_scan("octomap", scans_, context_, [&](const Scan& scan) {
      const std::vector<octomap::point3d> points = in_tree_frame(scan);
      const std::vector<PointRole> roles = roles_of(scan.index, points);
      side_by_side(context_, "beams and map update", take_in, [&](const RunContext& context) {
        find_cells(scan, points, roles, context.times);
      });
      std::swap(cells_, known_cells_);
    });
    take_in(context_);
  }

  void answer(RemovalSink& sink) {
    for_each_scan("octomap, answers", scans_, context_, [&](const Scan& scan) {
      const std::vector<octomap::point3d> points = in_tree_frame(scan);
      sink.accept(scan.index, removed(scan.index, points));
      if (context_.evidence == nullptr) return;
      context_.evidence->accept(scan.index, evidence(scan.index, points));
    });
    warn_of_points_outside();
  }

 private:
  [[nodiscard]] octomap::point3d rounded(const Eigen::Vector3d& point) const {
    return {static_cast<float>(point.x()), static_cast<float>(point.y()),
            static_cast<float>(point.z())};
  }

  /// World points relative to the tree's centre; computed in double, rounded once to float.
  [[nodiscard]] std::vector<octomap::point3d> in_tree_frame(const Scan& scan) const {
    const StageScope timed(context_.times, "transform");
    std::vector<octomap::point3d> points(scan.size());
    const Eigen::Matrix3d rotation = scan.T_world_sensor.linear();
    const Eigen::Vector3d translation = scan.T_world_sensor.translation() - centre_;
    parallel_for(context_.threads, scan.size(), 8192, [&](std::size_t k) {
      points[k] = rounded(rotation * scan.points[k].cast<double>() + translation);
    });
    return points;
  }

  std::vector<PointRole> roles_of(std::size_t scan, const std::vector<octomap::point3d>& points) {
    std::vector<PointRole> roles(points.size(), PointRole::kSurface);
    if (parameters_.noise) mark_noise(scan, points, roles);
    if (parameters_.ground) mark_ground(scan, points, roles);
    return roles;
  }

  void mark_noise(std::size_t scan, const std::vector<octomap::point3d>& points,
                  std::vector<PointRole>& roles) {
    const StageScope timed(context_.times, "noise filter");
    const Mask noise = find_noise(points, parameters_, context_.threads);
    const bool left_out = parameters_.noise_points == NoisePoints::kRemoved;
    for (std::size_t k = 0; k < noise.size(); ++k) {
      if (noise[k] != 0) roles[k] = left_out ? PointRole::kLeftOut : PointRole::kNoise;
    }
    if (left_out) dropped_.set(scan, noise);
  }

  /// The plane is looked for among the points that are no noise.
  void mark_ground(std::size_t scan, const std::vector<octomap::point3d>& points,
                   std::vector<PointRole>& roles) {
    const StageScope timed(context_.times, "ground plane");
    std::vector<octomap::point3d> candidates;
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
    kept_.set(scan, ground);
  }

  void find_cells(const Scan& scan, const std::vector<octomap::point3d>& points,
                  const std::vector<PointRole>& roles, StageTimes* times) {
    const StageScope timed(times, "beams");
    cells_.compute(points, roles, rounded(scan.T_world_sensor.translation() - centre_));
  }

  [[nodiscard]] Mask removed(std::size_t scan, const std::vector<octomap::point3d>& points) {
    const StageScope timed(context_.times, "answer");
    Mask mask(points.size(), 0);
    parallel_chunks(context_.threads, points.size(), 8192, [&](std::size_t begin, std::size_t end) {
      TreeReader reader(map_.tree());
      for (std::size_t k = begin; k < end; ++k) mask[k] = is_removed(points[k], reader) ? 1 : 0;
    });
    const Mask kept = kept_.get(scan), dropped = dropped_.get(scan);
    for (std::size_t k = 0; k < kept.size(); ++k) mask[k] = kept[k] != 0 ? 0 : mask[k];
    for (std::size_t k = 0; k < dropped.size(); ++k) mask[k] = dropped[k] != 0 ? 1 : mask[k];
    return mask;
  }

  /// How likely the leaf of each point is free; 0 for the ground, 1 for noise that goes, and one
  /// half where the tree knows nothing.
  [[nodiscard]] std::vector<float> evidence(std::size_t scan,
                                            const std::vector<octomap::point3d>& points) const {
    std::vector<float> free(points.size(), 0.5F);
    const Mask kept = kept_.get(scan), dropped = dropped_.get(scan);
    TreeReader reader(map_.tree());
    for (std::size_t k = 0; k < free.size(); ++k) {
      const std::optional<CellCode> cell = lattice_.cell_of(points[k]);
      const octomap::OcTreeNode* node = cell ? reader.find(*cell) : nullptr;
      if (node != nullptr) free[k] = static_cast<float>(1.0 - node->getOccupancy());
      if (!kept.empty() && kept[k] != 0) free[k] = 0.0F;
      if (!dropped.empty() && dropped[k] != 0) free[k] = 1.0F;
    }
    return free;
  }

  bool is_removed(const octomap::point3d& point, TreeReader& reader) {
    const std::optional<CellCode> cell = lattice_.cell_of(point);
    if (!cell) {
      ++outside_;
      return false;
    }
    const octomap::OcTreeNode* node = reader.find(*cell);
    return node == nullptr ? parameters_.remove_unknown : !map_.tree().isNodeOccupied(node);
  }

  void warn_of_points_outside() const {
    if (outside_ == 0 || context_.progress == nullptr) return;
    const double reach = CellLattice::kCentre * parameters_.resolution;
    context_.progress->say("octomap: " + grouped_text(outside_) + " points lie more than " +
                           fixed_text(reach, 1) +
                           " m from the first scan, outside the tree, and stay in the map "
                           "without a verdict; use a larger resolution, or fewer scans.");
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  const RunContext& context_;
  CellLattice lattice_;
  ScanCells cells_, known_cells_;  ///< Of the scan at hand, and of the one before it.
  CellBlocks wanted_;              ///< Cells in which any scan has a point.
  OccupancyTree map_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< The tree's centre in the world, metres.
  MaskStore kept_;     ///< Points on the ground, which stay whatever their leaf says.
  MaskStore dropped_;  ///< Points that the noise filter took out.
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
  // A build without PCL refuses before anything runs.
  if (parameters.ground && !kHasPcl) (void)find_ground({}, parameters);
  return remover_from(parameters, run);
}

}  // namespace raymoval::octomap_method
