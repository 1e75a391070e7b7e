// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/low_points.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/common/dense_blocks.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of step 8.
/// What is higher than so many metres does not stand on the points near the ground: legs and wheels
/// end below, tree tops and awnings do not. Far away the next beam above a wheel meets its car
/// higher up: so many metres more for each metre of range.
constexpr float kHighest = 1.0F, kHigherByRange = 0.03F;
/// Where beams are far apart, the next one above a bumper meets the bonnet behind it: what stands
/// is looked for so much farther aside, as a share of how far apart beams are at the point's range.
/// No more than so many columns to either side: a bonnet is not longer, and beams far apart must
/// not cost more.
constexpr float kWiderByBeams = 0.6F;
constexpr int kMostColumnsAside = 20;
/// Points near the ground follow the dynamic points above them if these are so many times the
/// others, and the other way round. Between, they stay what their voxels are.
constexpr int kMajority = 2;
/// A foot or a wheel ends on the ground, and its lowest points are taken for it. Those at least so
/// many metres above the mean of what was seen of the ground there follow what is dynamic above
/// them. Their height above the terrain does not tell them: beside a road, that of a pavement is as
/// high.
constexpr double kLeastAboveGround = 0.01;

/// What stands in a column of voxels.
struct Standing {
  std::uint32_t dynamic = 0, fixed = 0;  ///< Numbers of points.
  int marked = 0;  ///< So many columns to either side are marked, for what is dynamic here.
  bool is_near_dynamic = false;  ///< Something dynamic stands here or beside it.
  bool is_asked = false;         ///< A low point here or beside it wants to know.
};

/// The low points of one scan and what stands on them. Hardly anything in a scan is dynamic, so
/// only the columns are counted on which the verdict of a low point can depend.
class LowPoints {
 public:
  LowPoints(const LocatedScan& scan, const EvidenceMaps& maps, const Parameters& parameters,
            Verdicts& verdict)
      : scan_(scan),
        ground_(maps.ground),
        low_(static_cast<float>(parameters.object_height)),
        columns_wider_by_range_(kWiderByBeams * maps.elevation_step /
                                static_cast<float>(parameters.voxel_size)),
        farthest_aside_(std::sqrt(2.0F) * (kMostColumnsAside + 1) *
                        static_cast<float>(parameters.voxel_size)),
        verdict_(verdict) {}

  void decide() {
    count_dynamic();
    find_undecided();
    if (undecided_.empty()) return;
    count_fixed();
    for (const std::size_t k : undecided_) decide(k);
  }

 private:
  [[nodiscard]] bool is_standing(std::size_t k) const {
    const float height = scan_.height[k];
    if (height < low_) return false;
    return height < kHighest || height < kHighest + kHigherByRange * range(k);
  }
  /// Whether a point is so low that what stands above it may have a say in its verdict.
  [[nodiscard]] bool may_follow(std::size_t k) const {
    if (scan_.height[k] >= low_) return false;
    return scan_.has_standing_voxel(k) || !is_dynamic(k);
  }
  /// Whether a point of the ground lies above what was seen of the ground there, or was no ground
  /// itself when it was seen.
  [[nodiscard]] bool is_above_ground(std::size_t k) const {
    const std::uint32_t voxel = scan_.ground_voxel[k];
    if (voxel == EvidenceMap::kNone) return true;
    const std::uint32_t parts = ground_parts(scan_.in_map[k], scan_.in_map.parts[k]);
    return ground_.above_mean(voxel, parts) >= kLeastAboveGround;
  }
  [[nodiscard]] bool is_dynamic(std::size_t k) const { return verdict_[k] == Verdict::kDynamic; }
  [[nodiscard]] VoxelIndex column_of(std::size_t k) const {
    return {scan_.in_map.x[k], scan_.in_map.y[k], 0};
  }
  [[nodiscard]] float range(std::size_t k) const { return scan_.scan.points[k].norm(); }
  /// How many columns to either side may belong to what stands at a point: one near by, and more
  /// where beams are farther apart.
  [[nodiscard]] int reach(std::size_t k) const { return reach_at(range(k)); }
  [[nodiscard]] int reach_at(float range) const {
    const float wider = std::min<float>(columns_wider_by_range_ * range, kMostColumnsAside - 1);
    return 1 + static_cast<int>(wider);
  }
  /// Calls `visit(standing)` with the column of a point and those around it.
  template <class Visit>
  void for_columns_around(std::size_t k, int reach, Visit&& visit) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        visit(columns_.make(column_of(k) + VoxelIndex(x, y, 0), cursor_));
      }
    }
  }

  /// The range of the farthest low point that may reach up to a point.
  [[nodiscard]] float farthest_below(std::size_t k) const {
    return range(k) + farthest_aside_ + kHighest + kHigherByRange * range(k);
  }
  /// Counts the dynamic points of each column, and marks the columns from which one may be reached.
  void count_dynamic() {
    for (std::size_t k = 0; k < verdict_.size(); ++k) {
      if (!is_dynamic(k) || !is_standing(k)) continue;
      Standing& column = columns_.make(column_of(k), cursor_);
      ++column.dynamic;
      const int reach = reach_at(farthest_below(k));
      // The farthest point of a column counts, whichever comes first.
      if (column.marked >= reach) continue;
      column.marked = reach;
      for_columns_around(k, reach, [](Standing& standing) { standing.is_near_dynamic = true; });
    }
  }
  /// Finds the low points whose verdict what stands above them may change.
  void find_undecided() {
    for (std::size_t k = 0; k < verdict_.size(); ++k) {
      if (!may_follow(k)) continue;
      if (!is_dynamic(k) && !columns_.get(column_of(k), cursor_).is_near_dynamic) continue;
      if (!scan_.has_standing_voxel(k) && !is_above_ground(k)) continue;
      undecided_.push_back(k);
      for_columns_around(k, reach(k), [](Standing& standing) { standing.is_asked = true; });
    }
  }
  void count_fixed() {
    for (std::size_t k = 0; k < verdict_.size(); ++k) {
      if (is_dynamic(k) || !is_standing(k)) continue;
      if (!columns_.get(column_of(k), cursor_).is_asked) continue;
      ++columns_.make(column_of(k), cursor_).fixed;
    }
  }
  void decide(std::size_t k) {
    std::uint32_t dynamic = 0, fixed = 0;
    for_columns_around(k, reach(k), [&](const Standing& standing) {
      dynamic += standing.dynamic;
      fixed += standing.fixed;
    });
    if (dynamic > 0 && dynamic >= kMajority * fixed) {
      verdict_[k] = Verdict::kDynamic;
    } else if (scan_.has_standing_voxel(k) && fixed > 0 && fixed >= kMajority * dynamic) {
      verdict_[k] = Verdict::kStatic;
    }
  }

  using Columns = DenseBlocks<Standing, 4, 0>;
  const LocatedScan& scan_;
  const EvidenceMap& ground_;
  float low_;                     ///< Metres.
  float columns_wider_by_range_;  ///< 1 / m.
  float farthest_aside_;          ///< How far aside a point that is reached can be, metres.
  Verdicts& verdict_;
  Columns columns_{Standing{}};
  Columns::Cursor cursor_;
  std::vector<std::size_t> undecided_;
};

}  // namespace

void decide_low_points(const LocatedScan& scan, const EvidenceMaps& maps,
                       const Parameters& parameters, const RunContext& context, Verdicts& verdict) {
  if (!parameters.low_points || !parameters.terrain) return;
  const StageScope timed(context.times, "low points");
  LowPoints(scan, maps, parameters, verdict).decide();
}

}  // namespace raymoval::raymoval_plus_method
