// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/presence.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/scan/voxel_key.h"
#include "eval/points/nearby_points.h"
#include "eval/points/scan_loops.h"

namespace raymoval::dynamicmap {
namespace {

/// The smallest edge of the cells that say which kept points have to stay in memory.
constexpr double kSmallestEdge = 0.2;

Eigen::Vector3d placed(const Scan& scan, std::size_t point) {
  return scan.T_world_sensor * scan.points[point].cast<double>();
}

/// What the masks say of a scan themselves; calls `visit(scan, point, kind, removed)` on the way.
template <class Visit>
ScanPresence count_by_index(const TruthPoints& truth, const MaskStore& masks, std::size_t index,
                            Visit&& visit) {
  ScanPresence counts;
  counts.points =
      truth.read(index, &masks, [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
        if (kind == Kind::kStatic && !removed) ++counts.kept_static;
        if (kind == Kind::kDynamic && removed) ++counts.flagged_dynamic;
        visit(scan, p, kind, removed);
      });
  counts.present_static = counts.kept_static;
  counts.removed_dynamic = counts.flagged_dynamic;
  return counts;
}

/// Flagged points of the truth, scan after scan.
struct FlaggedPoints {
  std::vector<Eigen::Vector3d> points;  ///< World frame.
  std::vector<std::uint8_t> moving;
  std::vector<std::size_t> first = {0};  ///< Where the points of each scan begin, and the end.
};

/// Cells with flagged points in or beside them. A point in another cell is near no flagged point.
class CellsAround {
 public:
  CellsAround(const std::vector<Eigen::Vector3d>& points, double distance)
      : inverse_edge_(1.0 / std::max(2.0 * distance, kSmallestEdge)) {
    VoxelSet own;
    for (const Eigen::Vector3d& point : points) own.insert(key_of(point));
    for (const VoxelKey key : own) add_neighbours(voxel_index(key));
  }

  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    return !cells_.empty() && cells_.contains(key_of(point));
  }

 private:
  [[nodiscard]] VoxelKey key_of(const Eigen::Vector3d& point) const {
    return voxel_key(voxel_index(point, inverse_edge_));
  }
  void add_neighbours(const VoxelIndex& cell) {
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          cells_.insert(voxel_key(cell.x() + x, cell.y() + y, cell.z() + z));
        }
      }
    }
  }

  double inverse_edge_;
  VoxelSet cells_;
};

class Measurement {
 public:
  Measurement(const TruthPoints& truth, const MaskStore& masks, const Options& options)
      : truth_(truth), masks_(masks), options_(options), scans_(truth.input().scans->size()) {}

  std::vector<ScanPresence> run() {
    const FlaggedPoints flagged = collect_flagged();
    const std::vector<Eigen::Vector3d> kept =
        collect_kept(CellsAround(flagged.points, options_.distance));
    const NearbyPoints<Eigen::Vector3d> near(kept, options_.distance);
    parallel_for(truth_.input().threads, scans_.size(), 1, [&](std::size_t scan) {
      for (std::size_t i = flagged.first[scan]; i < flagged.first[scan + 1]; ++i) {
        if (near.has_near(flagged.points[i])) add_present(scans_[scan], flagged.moving[i] != 0);
      }
    });
    return std::move(scans_);
  }

 private:
  /// Counts what the masks say themselves, and collects what has to be searched for.
  FlaggedPoints collect_flagged() {
    struct Part {
      std::vector<Eigen::Vector3d> points;
      std::vector<std::uint8_t> moving;
    };
    FlaggedPoints all;
    const auto read = [&](std::size_t scan_index) {
      Part part;
      ScanPresence& counts = scans_[scan_index];
      counts = count_by_index(truth_, masks_, scan_index,
                              [&](const Scan& scan, std::size_t p, Kind kind, bool removed) {
                                if (!removed || !is_truth(kind)) return;
                                part.points.push_back(placed(scan, p));
                                part.moving.push_back(kind == Kind::kDynamic ? 1 : 0);
                              });
      return part;
    };
    in_scan_order<Part>(truth_.input(), "points that are gone", read, [&](const Part& part) {
      all.points.insert(all.points.end(), part.points.begin(), part.points.end());
      all.moving.insert(all.moving.end(), part.moving.begin(), part.moving.end());
      all.first.push_back(all.points.size());
    });
    return all;
  }

  /// Points of the estimate that may be near a flagged one.
  std::vector<Eigen::Vector3d> collect_kept(const CellsAround& cells) {
    using Part = std::vector<Eigen::Vector3d>;
    Part all;
    const auto read = [&](std::size_t scan_index) {
      Part part;
      (void)truth_.read(scan_index, &masks_,
                        [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
                          if (!in_estimate(kind, removed)) return;
                          const Eigen::Vector3d point = placed(scan, p);
                          if (cells.contains(point)) part.push_back(point);
                        });
      return part;
    };
    in_scan_order<Part>(truth_.input(), "points near those gone", read,
                        [&](const Part& part) { all.insert(all.end(), part.begin(), part.end()); });
    return all;
  }

  /// Whether a point stands in the map that is scored; its label is not looked at.
  [[nodiscard]] bool in_estimate(Kind kind, bool removed) const {
    return !removed && (is_truth(kind) || options_.ignored_in_estimate);
  }

  /// A flagged point that is there all the same.
  static void add_present(ScanPresence& counts, bool moving) {
    if (moving) {
      --counts.removed_dynamic;
    } else {
      ++counts.present_static;
    }
  }

  const TruthPoints& truth_;
  const MaskStore& masks_;
  const Options& options_;
  std::vector<ScanPresence> scans_;
};

}  // namespace

ScanPresence& ScanPresence::operator+=(const ScanPresence& other) {
  points += other.points;
  kept_static += other.kept_static;
  flagged_dynamic += other.flagged_dynamic;
  present_static += other.present_static;
  removed_dynamic += other.removed_dynamic;
  return *this;
}

std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks) {
  std::vector<ScanPresence> scans(truth.input().scans->size());
  parallel_for(truth.input().threads, scans.size(), 1, [&](std::size_t i) {
    scans[i] = count_by_index(truth, masks, i, [](const Scan&, std::size_t, Kind, bool) {});
  });
  return scans;
}

std::vector<ScanPresence> measure_presence(const TruthPoints& truth, const MaskStore& masks,
                                           const Options& options) {
  return Measurement(truth, masks, options).run();
}

}  // namespace raymoval::dynamicmap
