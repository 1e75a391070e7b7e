// SPDX-License-Identifier: MIT
#include "datasets/registration/register_scans.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "core/point_tree.h"
#include "core/sampling.h"
#include "datasets/geometry/surface_patches.h"
#include "datasets/registration/plane_step.h"

namespace raymoval::registration {
namespace {

constexpr float kNearest = 0.5F, kFarthest = 60.0F;  // metres
constexpr float kNearestShare = 0.25F;               // of the median range

float median_range_of(const Scan& scan) {
  std::vector<float> ranges;
  ranges.reserve(scan.size());
  for (const Eigen::Vector3f& point : scan.points) ranges.push_back(point.norm());
  return ranges.empty() ? 0.0F : median_in_place(ranges);
}

Eigen::Vector3d mean_of(std::span<const PlacedPoint> points) {
  Eigen::Matrix<std::int64_t, 3, 1> sum = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
  for (const PlacedPoint& p : points) sum += p.at.cast<std::int64_t>();
  return 0.001 * sum.cast<double>() / static_cast<double>(points.size());
}

std::vector<SurfacePoint> surface_points(const Scan& scan, float nearest) {
  std::vector<SurfacePoint> surfaces;
  for_each_patch(scan, nearest, kFarthest,
                 [&](const SurfacePatch& patch, std::span<const PlacedPoint> points) {
                   for_each_cell(points, kPlacedBits, [&](std::span<const PlacedPoint> cell) {
                     const Eigen::Vector3d mean = mean_of(cell);
                     const double above = patch.normal.dot(mean - patch.mean);
                     surfaces.push_back(
                         {(mean - above * patch.normal).cast<float>(), patch.normal.cast<float>()});
                   });
                 });
  return surfaces;
}

}  // namespace

struct SurfaceCloud::Tree {
  explicit Tree(std::vector<SurfacePoint> of) : points(std::move(of)), index(points) {}
  std::vector<SurfacePoint> points;
  PointTree<SurfacePoint> index;
};

SurfaceCloud::SurfaceCloud(const Scan& scan) {
  const float median = median_range_of(scan);
  median_range_ = median;
  tree_ = std::make_unique<Tree>(surface_points(scan, std::max(kNearest, kNearestShare * median)));
}

SurfaceCloud::~SurfaceCloud() = default;
SurfaceCloud::SurfaceCloud(SurfaceCloud&&) noexcept = default;

const std::vector<SurfacePoint>& SurfaceCloud::points() const {
  return tree_->points;
}

const SurfacePoint* SurfaceCloud::nearest(const Eigen::Vector3f& position, float reach) const {
  return tree_->index.nearest(position.data(), reach);
}

namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostPoints = 1500;
constexpr std::size_t kFewPoints = 300;  // They show whether a wide reach is worth its time.
constexpr std::size_t kFewestMatches = 50;
constexpr float kLikeNormal = 0.85F;  // cosine
constexpr double kOnSurface = 0.1;    // metres
constexpr double kLeastReach = 0.6;   // metres from a point to its counterpart
constexpr double kWideReach = 3.0;    // the same for guesses with a large error
constexpr double kOtherReach = 1.5;   // the same for other guesses
constexpr double kLeastCut = 0.05;    // metres at which Tukey's weight ends
constexpr double kOnePlace = 0.5;     // metres
constexpr double kAcross = 0.3;       // Least sine of the angle between a way and a surface across.
constexpr double kClearlyBetter = 0.2;  // Least gain in overlap across the way from the guess.
constexpr int kSteps = 15;

Matches find_matches(const SurfaceCloud& from, const std::vector<SurfacePoint>& points,
                     const Pose& motion, double reach) {
  Matches matches;
  const Eigen::Isometry3f T = motion.cast<float>();
  for (const SurfacePoint& point : points) {
    const Eigen::Vector3f at = T * point.position;
    const SurfacePoint* other = from.nearest(at, static_cast<float>(reach));
    if (other == nullptr || other->normal.dot(T.linear() * point.normal) < kLikeNormal) continue;
    const float distance = other->normal.dot(at - other->position);
    matches.push_back({at.cast<double>(), other->normal.cast<double>(), distance});
  }
  return matches;
}

double overlap_of(const Matches& matches, std::size_t points) {
  double sum = 0.0;
  for (const Match& match : matches) {
    sum += std::max(0.0, 1.0 - std::abs(match.distance) / kOnSurface);
  }
  return points == 0 ? 0.0 : sum / static_cast<double>(points);
}

/// Searches counterparts within `reach` metres at first, and nearer with each step.
Pose refine(const SurfaceCloud& from, const std::vector<SurfacePoint>& points, Pose motion,
            double reach) {
  for (int k = 0; k < kSteps; ++k) {
    const double now = std::max(kLeastReach, reach * std::pow(0.7, k));
    const Matches matches = find_matches(from, points, motion, now);
    if (matches.size() < kFewestMatches) break;
    const double loose = 0.6 * reach * std::pow(0.6, k);
    const double cut = std::max({3.0 * robust_deviation(matches), kLeastCut, loose});
    const Pose step = plane_step(matches, cut).motion;
    motion = step * motion;
    const double moved =
        step.translation().norm() + 10.0 * (step.linear() - Eigen::Matrix3d::Identity()).norm();
    if (now <= kLeastReach && moved < 0.001) break;
  }
  return motion;
}

std::vector<SurfacePoint> thinned(const std::vector<SurfacePoint>& all, std::size_t most) {
  std::vector<SurfacePoint> some;
  for (const std::size_t i : evenly_spread(all.size(), most)) some.push_back(all[i]);
  return some;
}

/// As many points with normals along each axis: ground far away and in rings would outweigh the few
/// points that determine a motion along it (sampling of normals, Rusinkiewicz and Levoy 2001).
std::vector<SurfacePoint> balanced(const std::vector<SurfacePoint>& all) {
  std::array<std::vector<SurfacePoint>, 3> groups;
  for (const SurfacePoint& point : all) {
    Eigen::Index axis = 0;
    point.normal.cwiseAbs().maxCoeff(&axis);
    groups[static_cast<std::size_t>(axis)].push_back(point);
  }
  std::vector<SurfacePoint> some;
  for (const auto& group : groups) {
    const auto chosen = thinned(group, kFewPoints / groups.size());
    some.insert(some.end(), chosen.begin(), chosen.end());
  }
  return some;
}

/// Overlaps before and after a change of the motion, of the points on surfaces across the change; 0
/// if there are few.
std::array<double, 2> overlaps_across(const SurfaceCloud& from,
                                      const std::vector<SurfacePoint>& points, const Pose& before,
                                      const Pose& after) {
  std::vector<SurfacePoint> across;
  for (const SurfacePoint& point : points) {
    const Vector3d at = point.position.cast<double>();
    const Vector3d moved = after * at - before * at;
    const double along_normal = (after.linear() * point.normal.cast<double>()).dot(moved);
    if (std::abs(along_normal) >= kAcross * moved.norm()) across.push_back(point);
  }
  across = thinned(across, kFewPoints);
  if (across.size() < kFewestMatches) return {0.0, 0.0};
  const auto overlap = [&](const Pose& motion) {
    return overlap_of(find_matches(from, across, motion, kLeastReach), across.size());
  };
  return {overlap(before), overlap(after)};
}

/// A guess, and the distance to counterparts that is searched from it.
struct Start {
  Pose guess;
  double reach;
};

/// The motion with the largest overlap that registration of a few points reaches from `starts`, if
/// it is clearly better than `reached` on the surfaces across the way between the two.
std::optional<Pose> far_motion(const SurfaceCloud& from, const SurfaceCloud& to,
                               const std::vector<SurfacePoint>& points,
                               const std::vector<Start>& starts, const Pose& reached) {
  const std::vector<SurfacePoint> few = balanced(points);
  const auto overlap = [&](const Pose& motion) {
    return overlap_of(find_matches(from, few, motion, kLeastReach), few.size());
  };
  std::optional<Pose> best;
  double most = overlap(reached);
  for (const Start& start : starts) {
    const Pose motion = refine(from, few, start.guess, start.reach);
    // From one place, rings on the ground and vehicles that move along look alike at any time.
    if (motion.translation().norm() < kOnePlace) continue;
    const double found = overlap(motion);
    if (found <= most) continue;
    most = found;
    best = motion;
  }
  if (!best) return best;
  // Far from the guess, another surface may fit a little by chance.
  const auto [before, after] = overlaps_across(from, to.points(), reached, *best);
  return after > before + kClearlyBetter ? best : std::nullopt;
}

}  // namespace

Registration register_scans(const SurfaceCloud& from, const SurfaceCloud& to, const Pose& guess,
                            const std::vector<Pose>& others) {
  const std::vector<SurfacePoint> points = thinned(to.points(), kMostPoints);
  Registration best{.T_from_to = guess};
  Matches matches = find_matches(from, points, guess, kLeastReach);
  best.overlap = best.overlap_of_guess = overlap_of(matches, points.size());
  const auto improve = [&](const Pose& motion, bool is_far) {
    Matches found = find_matches(from, points, motion, kLeastReach);
    const double overlap = overlap_of(found, points.size());
    if (!is_far && overlap <= best.overlap) return;
    best.T_from_to = motion;
    best.overlap = overlap;
    matches = std::move(found);
  };
  improve(refine(from, points, guess, kLeastReach), false);
  std::vector<Start> starts = {{guess, kWideReach}};
  for (const Pose& other : others) starts.push_back({other, kOtherReach});
  if (const auto far = far_motion(from, to, points, starts, best.T_from_to)) improve(*far, true);
  const auto across = overlaps_across(from, to.points(), guess, best.T_from_to);
  best.overlap_across_of_guess = across[0];
  best.overlap_across = across[1];
  best.matched = matches.size();
  best.noise = robust_deviation(matches);
  const Pose back = guess * best.T_from_to.inverse();
  double square = 0.0, square_of_points = 0.0;
  for (const Match& match : matches) {
    const Vector3d moved = back * match.at - match.at;
    square += std::pow(match.normal.dot(moved), 2);
    square_of_points += moved.squaredNorm();
  }
  if (matches.empty()) return best;
  best.shift = std::sqrt(square / static_cast<double>(matches.size()));
  best.shift_of_points = std::sqrt(square_of_points / static_cast<double>(matches.size()));
  return best;
}

}  // namespace raymoval::registration
