// SPDX-License-Identifier: MIT
#include "methods/octomap/scan_cells.h"

#include <algorithm>
#include <atomic>

#include "core/parallel.h"

namespace raymoval::octomap_method {
namespace {

/// Beams that one part takes at a time, so that each gets near and far ones.
constexpr std::size_t kBeamsInTurn = 512;

}  // namespace

ScanCells::ScanCells(const Parameters& parameters, const RunContext& context)
    : parameters_(&parameters),
      context_(&context),
      lattice_(parameters.resolution),
      threads_(std::clamp(context.threads, 1, 64)),
      parts_(static_cast<std::size_t>(threads_)) {}

void ScanCells::compute(const std::vector<octomap::point3d>& points,
                        const std::vector<PointRole>& roles, const octomap::point3d& origin) {
  clear();
  collect_beams(points, roles, origin);
  const BeamTracer tracer(lattice_, origin);
  // Whoever has time takes the next beams: the union does not depend on which part they are in.
  std::atomic<std::size_t> next_turn{0};
  parallel_for(threads_, parts_.size(), 1, [&](std::size_t part) {
    while (true) {
      const std::size_t begin = next_turn++ * kBeamsInTurn;
      if (begin >= beams_.size()) return;
      context_->check_cancelled();
      const std::size_t end = std::min(beams_.size(), begin + kBeamsInTurn);
      for (std::size_t i = begin; i < end; ++i) {
        const Beam& beam = beams_[i];
        tracer.mark_free(beam.end, beam.last, parts_[part]);
        if (beam.hits) parts_[part].occupy(beam.last);
      }
    }
  });
}

void ScanCells::collect_beams(const std::vector<octomap::point3d>& points,
                              const std::vector<PointRole>& roles, const octomap::point3d& origin) {
  beams_.clear();
  std::vector<std::pair<CellCode, PointRole>> ends;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (roles[i] == PointRole::kLeftOut) continue;
    const std::optional<CellCode> cell = lattice_.cell_of(points[i]);
    if (!cell) continue;
    if (roles[i] == PointRole::kNoise) {
      parts_[0].occupy(*cell);
    } else if (parameters_->discretise) {
      ends.emplace_back(*cell, roles[i]);
    } else {
      add_beam(points[i], *cell, roles[i], origin);
    }
  }
  // One beam to the centre of each cell that has an end of either kind.
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const auto& [cell, role] : ends) add_beam(lattice_.centre(cell), cell, role, origin);
}

void ScanCells::add_beam(const octomap::point3d& end, CellCode last, PointRole role,
                         const octomap::point3d& origin) {
  const double range = (end - origin).norm();
  if (parameters_->minimum_range > 0.0 && range < parameters_->minimum_range) return;
  if (parameters_->maximum_range < 0.0 || range <= parameters_->maximum_range) {
    beams_.push_back({end, last, role == PointRole::kSurface});
    return;
  }
  const octomap::point3d direction = (end - origin).normalized();
  const octomap::point3d cut = origin + direction * static_cast<float>(parameters_->maximum_range);
  const std::optional<CellCode> cell = lattice_.cell_of(cut);
  if (!cell) return;
  beams_.push_back({cut, *cell, false});
  if (parameters_->cut_end_free && role == PointRole::kSurface) {
    parts_[0].block(*cell >> kBlockBits).free[*cell >> 6 & 7] |= std::uint64_t{1} << (*cell & 63);
  }
}

}  // namespace raymoval::octomap_method
