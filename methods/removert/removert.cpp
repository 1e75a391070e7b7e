// SPDX-License-Identifier: MIT
// "Remove, then Revert: Static Point cloud Map Construction using Multiresolution Range Images",
// Kim and Kim, IROS 2020. What is decided on what evidence stands in README.md.
#include "methods/removert/removert.h"

#include <string>

#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/common/thinned_points.h"
#include "methods/removert/answer.h"
#include "methods/removert/map_points.h"
#include "methods/removert/scan_image.h"
#include "methods/removert/visibility.h"

namespace raymoval::removert_method {
namespace {

/// Centroids of the scan's points in cubes of `voxel` metres of the sensor frame, in order of first
/// appearance; the points themselves for 0.
std::vector<Eigen::Vector3f> thinned(std::vector<Eigen::Vector3f> points, double voxel) {
  if (voxel <= 0.0) return points;
  ThinnedPoints centroids(voxel);
  for (const Eigen::Vector3f& point : points) centroids.add(point.cast<double>());
  points.clear();
  for (std::size_t i = 0; i < centroids.size(); ++i) {
    points.emplace_back(centroids.centroid(i).cast<float>());
  }
  return points;
}

/// Remove, then revert, for scans [begin, end) of the input.
class RemovertBatch {
 public:
  RemovertBatch(const Parameters& parameters, const ScanSource& scans, std::size_t begin,
                std::size_t end, const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        begin_(begin),
        end_(end),
        context_(context),
        lattice_(parameters.map_voxel),
        first_number_(end - begin + 1, 0) {}

  void run(RemovalSink& sink) {
    MapPoints map = collect_map();
    MapPoints removed = remove(map);
    revert(map, removed);
    answer(map, removed, sink);
  }

 private:
  [[nodiscard]] ScanSelection keyframes() const {
    return every_nth_scan(begin_, end_, static_cast<std::size_t>(parameters_.keyframe_gap));
  }

  /// The merged and thinned scans. The map is collected once.
  MapPoints collect_map() {
    MapBuilder builder(lattice_);
    std::uint64_t number = 0;
    for_each_scan("removert, map", scans_, keyframes(), context_, [&](const Scan& scan) {
      const StageScope stage(context_.times, "map");
      first_number_[scan.index - begin_] = number;
      builder.add(thinned(scan.points, parameters_.scan_voxel), scan.T_world_sensor, number,
                  context_.threads);
      number += scan.size();
    });
    const StageScope stage(context_.times, "map");
    return builder.finish();
  }

  /// One pass per resolution, fine to coarse. @return what was taken out of `map`
  MapPoints remove(MapPoints& map) {
    const Candidates candidates = candidates_for(false);
    MapPoints removed;
    std::vector<std::uint8_t> flagged(map.size(), 0);
    for (const double resolution : parameters_.remove_resolutions()) {
      flag_dynamic(map, resolution, candidates, flagged);
      if (!parameters_.update_between_passes) continue;
      removed = united(removed, take_points(map, flagged));
      flagged.assign(map.size(), 0);
    }
    if (!parameters_.update_between_passes) removed = take_points(map, flagged);
    return removed;
  }

  /// Compares the removed points alone with all scans; those not flagged go back to `map`.
  void revert(MapPoints& map, MapPoints& removed) {
    const Candidates candidates = candidates_for(parameters_.revert_needs_view);
    for (const double resolution : parameters_.revert_resolutions()) {
      const Votes votes = compare(removed, resolution, candidates);
      std::vector<std::uint8_t> restored(removed.size(), 0);
      for (std::size_t i = 0; i < restored.size(); ++i) {
        const bool unseen = parameters_.revert_needs_view && votes.still[i] == 0;
        restored[i] = !unseen && !is_dynamic(votes, i) ? 1 : 0;
      }
      map = united(map, take_points(removed, restored));
    }
  }

  /// Which points of a map a pass has to look at.
  [[nodiscard]] Candidates candidates_for(bool needs_view) const {
    const bool needs_all = needs_view || parameters_.difference == DifferenceRule::kAbsolute ||
                           parameters_.decision == DecisionRule::kScore;
    return needs_all ? Candidates::kAll : Candidates::kInFront;
  }

  void flag_dynamic(const MapPoints& map, double resolution, Candidates candidates,
                    std::vector<std::uint8_t>& flagged) {
    const Votes votes = compare(map, resolution, candidates);
    for (std::size_t i = 0; i < flagged.size(); ++i) {
      if (is_dynamic(votes, i)) flagged[i] = 1;
    }
  }

  [[nodiscard]] bool is_dynamic(const Votes& votes, std::size_t i) const {
    if (parameters_.decision == DecisionRule::kAny) return votes.dynamic[i] > 0;
    return parameters_.static_weight * votes.still[i] -
               parameters_.dynamic_weight * votes.dynamic[i] <
           parameters_.static_score;
  }

  /// Votes of all scans on `map`, which stays as it is meanwhile.
  Votes compare(const MapPoints& map, double resolution, Candidates candidates) {
    const PixelGrid grid(parameters_, resolution);
    VisibilityPass pass(map, parameters_, candidates);
    for_scans_in_parallel("removert, range images", scans_, keyframes(), context_,
                          [&](const Scan& scan) {
                            const ScanImage image = image_of(scan, grid, candidates);
                            const StageScope stage(context_.times, "visibility");
                            pass.show(image, T_image_world(scan));
                          });
    return pass.votes();
  }

  [[nodiscard]] ScanImage image_of(const Scan& scan, const PixelGrid& grid,
                                   Candidates candidates) const {
    const StageScope stage(context_.times, "scan image");
    return {thinned(points_in_image_axes(scan, parameters_.world_axes), parameters_.scan_voxel),
            grid, parameters_, candidates};
  }

  [[nodiscard]] Pose T_image_world(const Scan& scan) const {
    if (!parameters_.world_axes) return scan.T_world_sensor.inverse();
    Pose shift = Pose::Identity();
    shift.translation() = -scan.T_world_sensor.translation();
    return shift;
  }

  void answer(const MapPoints& map, const MapPoints& removed, RemovalSink& sink) {
    const bool all_points_in_map = parameters_.keyframe_gap == 1 && parameters_.scan_voxel == 0.0;
    std::unique_ptr<Answer> answer;
    {
      const StageScope stage(context_.times, "answer");
      answer = parameters_.scan_side ? answer_by_neighbours(map, parameters_)
                                     : answer_by_cell(lattice_, map, removed, all_points_in_map);
    }
    for_scans_in_parallel("removert, answers", scans_, every_nth_scan(begin_, end_, 1), context_,
                          [&](const Scan& scan) {
                            const StageScope stage(context_.times, "answer");
                            sink.accept(scan.index,
                                        answer->of(scan, first_number_[scan.index - begin_]));
                          });
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  std::size_t begin_, end_;
  const RunContext& context_;
  CellLattice lattice_;
  std::vector<std::uint64_t> first_number_;  ///< The number of each scan's first point, if all
                                             ///< points are in the map.
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  const std::size_t batch =
      parameters.batch_scans == 0 ? scans.size() : static_cast<std::size_t>(parameters.batch_scans);
  for (std::size_t begin = 0; begin < scans.size(); begin += batch) {
    const std::size_t end = std::min(begin + batch, scans.size());
    RemovertBatch(parameters, scans, begin, end, context).run(sink);
  }
}

}  // namespace

std::unique_ptr<Remover> make_removert(const Parameters& parameters) {
  if (parameters.map_voxel > 0.0 && parameters.map_voxel < 0.01) {
    throw ConfigurationError(
        "removert.map_voxel is below 0.01 m; give 0 to keep every point, or at least 0.01.");
  }
  if (parameters.map_voxel == 0.0 && (parameters.keyframe_gap > 1 || parameters.scan_voxel > 0.0)) {
    throw ConfigurationError(
        "removert.map_voxel = 0 answers for the points of the map only; points left out by "
        "keyframe_gap or scan_voxel need a voxel size, such as 0.05.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::removert_method
