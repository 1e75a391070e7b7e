// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/journeys.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "core/sampling.h"
#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step.
/// An object moved if its centre did by so many metres, and by this share of its length: the centre
/// of a standing thing shifts by less when other sides of it come into sight.
constexpr double kLeastMotion = 0.5, kLeastMotionShare = 0.25;
/// An object is in its place while it moved by no more than this share of its width.
constexpr double kPlaceShare = 1.0;
/// Of the objects of a track that stands, at least this share is dynamic: it came or leaves.
constexpr double kCameOrLeaves = 0.25;
/// An object may be hit so many scans, and this share of its stay, before the stay or after it.
constexpr double kStaySlack = 3.0, kStaySlackShare = 0.25;
/// So many scans hit what stood always.
constexpr float kManyHits = 10.0F;
/// What stands may be so many times, and by so many metres, wider than anything of its track that
/// was seen to be dynamic. From nearer by more of it is in sight; a parked car whose track a drop
/// of rain or a walker took over is larger by far.
constexpr double kWider = 1.5, kWiderMetres = 0.6;

/// The scans in which the object of a track is in one place.
struct Stay {
  std::size_t first, last;
  [[nodiscard]] int scans() const { return 1 + scans_between(first, last); }
};

/// The scans from one of a track's objects to another; tracks also lead backward.
Stay stay_between(const Track::Node& a, const Track::Node& b) {
  return {std::min(a.scan, b.scan), std::max(a.scan, b.scan)};
}

/// By how much a thing moved at least, seen from above, if both objects are what was in sight of
/// it; metres. Other sides come into sight, so that one box may hold the other, or an edge of it
/// stays where it is, while the centre shifts.
double least_shift(const ObjectSummary& a, const ObjectSummary& b) {
  const Eigen::Array2d low = (b.low - a.low).head<2>(), high = (b.high - a.high).head<2>();
  return (low * high > 0.0).select(low.abs().min(high.abs()), 0.0).matrix().norm();
}

/// Whether two objects of a track are in the same place.
bool are_in_one_place(const ObjectSummary& a, const ObjectSummary& b) {
  return least_shift(a, b) <= kPlaceShare * std::min(a.width(), b.width());
}

/// The scans that one of a track's objects spends where it is then: those before and after in which
/// it is in the same place.
/// @param longest a stay that is longer than so many scans is not looked at to its end
Stay stay_of(const Track& track, std::size_t at,
             double longest = std::numeric_limits<double>::infinity()) {
  const std::vector<Track::Node>& nodes = track.nodes;
  std::size_t first = at, last = at;
  const auto goes_on_to = [&](std::size_t k) {
    return stay_between(nodes[first], nodes[last]).scans() <= longest &&
           are_in_one_place(nodes[k].object, nodes[at].object);
  };
  while (last + 1 < nodes.size() && goes_on_to(last + 1)) ++last;
  while (first > 0 && goes_on_to(first - 1)) --first;
  return stay_between(nodes[first], nodes[last]);
}

/// Whether one of a track's objects goes on, and does not stand: it is in its place for no longer
/// than its length and speed explain.
bool goes_on(const Track& track, std::size_t at, const Motion& motion,
             const Parameters& parameters) {
  const double passing = scans_passing(track.nodes[at].object, motion, parameters) + kScansMore;
  return stay_of(track, at, passing).scans() <= passing;
}

/// Whether enough of a track's objects are dynamic. Those that stand do not count against it: where
/// something stands for long, often nothing was seen before or after.
bool is_mostly_dynamic(const Track& track, const Motion& motion, const Parameters& parameters) {
  int dynamic = 0, others = 0;
  for (std::size_t k = 0; k < track.nodes.size(); ++k) {
    if (is_dynamic(track.nodes[k].object, parameters)) {
      ++dynamic;
    } else if (goes_on(track, k, motion, parameters)) {
      ++others;
    }
  }
  return dynamic >= parameters.track_dynamic_share * static_cast<double>(dynamic + others);
}

/// How the object of a track moved, if its dynamic objects are far enough from each other.
std::optional<Motion> motion_of(const Track& track, const Parameters& parameters) {
  std::vector<double> widths;
  const Track::Node *first = nullptr, *last = nullptr;
  for (const Track::Node& node : track.nodes) {
    widths.push_back(node.object.width());
    if (!is_dynamic(node.object, parameters)) continue;
    if (first == nullptr) first = &node;
    last = &node;
  }
  const double typical = median(std::move(widths));
  const double moved = (last->object.center - first->object.center).head<2>().norm();
  if (moved < std::max(kLeastMotion, kLeastMotionShare * typical)) return std::nullopt;
  return Motion{typical, moved / scans_between(first->scan, last->scan)};
}

/// Whether enough of the objects of a track that stands are dynamic: it came or leaves.
bool came_or_leaves(const Track& track, const Parameters& parameters) {
  return dynamic_objects(track, parameters) >=
         kCameOrLeaves * static_cast<double>(track.nodes.size());
}

/// How the object of a track goes.
struct Journey {
  std::optional<Motion> motion;  ///< None if it came or leaves, and stands else.
  Stay dynamic;                  ///< From its first dynamic object to its last one.
  double widest;                 ///< What stands and is wider does not belong to it; metres.
};

/// The width of the widest of a track's dynamic objects, metres.
double dynamic_width(const Track& track, const Parameters& parameters) {
  double width = 0.0;
  for (const Track::Node& node : track.nodes) {
    if (is_dynamic(node.object, parameters)) width = std::max(width, node.object.width());
  }
  return width;
}

/// How the object of a track moved, came or leaves, if that is known.
std::optional<Journey> journey_of(const Track& track, const Parameters& parameters) {
  if (dynamic_objects(track, parameters) < kLeastDynamic) return std::nullopt;
  const auto motion = motion_of(track, parameters);
  const bool is_known =
      motion ? is_mostly_dynamic(track, *motion, parameters) : came_or_leaves(track, parameters);
  if (!is_known) return std::nullopt;
  const auto is_one = [&](const Track::Node& node) { return is_dynamic(node.object, parameters); };
  const auto first = std::find_if(track.nodes.begin(), track.nodes.end(), is_one);
  const auto last = std::find_if(track.nodes.rbegin(), track.nodes.rend(), is_one);
  return Journey{motion, stay_between(*first, *last),
                 kWider * dynamic_width(track, parameters) + kWiderMetres};
}

/// Whether many scans hit an object, and next to no beam passed where it is before or after: no
/// track makes it dynamic.
bool stood_always(const ObjectSummary& object, const Parameters& parameters) {
  return object.hits >= kManyHits &&
         object.evidence.passes < parameters.object_least_passes * object.points;
}

/// Whether one of a track's objects belongs to what moved, came or leaves: scans agree on it no
/// longer than its length and speed explain, or than it was followed while it stood.
bool belongs(const Track& track, std::size_t at, const Journey& journey,
             const Parameters& parameters) {
  const ObjectSummary& object = track.nodes[at].object;
  // What came or leaves, and stands else, is in one place all the time.
  const Stay stay =
      journey.motion ? stay_of(track, at) : stay_between(track.nodes.front(), track.nodes.back());
  const double slack = kStaySlack + kStaySlackShare * stay.scans();
  if (object.width() > journey.widest || stood_always(object, parameters)) return false;
  return object.first_hit >= static_cast<double>(stay.first) - slack &&
         object.last_hit <= static_cast<double>(stay.last) + slack;
}

void sort_and_unite(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// All tracks through the objects of all scans.
std::vector<Track> followed(const std::vector<std::vector<ObjectSummary>>& scans, bool backward,
                            ObjectTracker tracker) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::size_t scan = backward ? scans.size() - 1 - i : i;
    tracker.follow(scan, scans[scan]);
  }
  return tracker.finish();
}

/// Whether one of a track's objects goes on, and scans hit its place no longer than that explains.
bool passes_by(const Track& track, std::size_t at, const Journey& journey,
               const Parameters& parameters) {
  return journey.motion && goes_on(track, at, *journey.motion, parameters) &&
         is_explained(track.nodes[at].object, *journey.motion, parameters);
}

/// Clusters of each scan.
using Marked = std::vector<std::vector<int>>;

/// Adds what one track says.
void judge(const Track& track, const Parameters& parameters, Marked& marked) {
  const auto journey = journey_of(track, parameters);
  if (!journey) return;
  for (std::size_t k = 0; k < track.nodes.size(); ++k) {
    const auto& [scan, object] = track.nodes[k];
    if (is_dynamic(object, parameters)) continue;
    if (belongs(track, k, *journey, parameters) || passes_by(track, k, *journey, parameters)) {
      marked[scan].push_back(object.cluster);
    }
  }
}

}  // namespace

std::vector<int> marked_in(std::size_t scan, const std::vector<Track>& tracks,
                           const Parameters& parameters) {
  std::vector<int> marked;
  for (const Track& track : tracks) {
    // The nodes are few, and those looked for are mostly the last ones.
    const auto node = std::find_if(track.nodes.rbegin(), track.nodes.rend(),
                                   [&](const Track::Node& some) { return some.scan == scan; });
    if (node == track.nodes.rend()) continue;
    if (is_dynamic(node->object, parameters)) continue;
    const auto journey = journey_of(track, parameters);
    const auto at = static_cast<std::size_t>(track.nodes.rend() - node) - 1;
    if (journey && belongs(track, at, *journey, parameters)) {
      marked.push_back(node->object.cluster);
    }
  }
  return marked;
}

std::vector<std::vector<int>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans, const Parameters& parameters,
    const RunContext& context) {
  const StageScope timed(context.times, "tracks");
  std::array<Marked, 2> found;  // Forward and backward in time.
  parallel_for(context.threads, found.size(), 1, [&](std::size_t i) {
    found[i].resize(scans.size());
    for (const Track& track : followed(scans, i == 1, ObjectTracker(parameters))) {
      judge(track, parameters, found[i]);
    }
  });
  for (std::size_t scan = 0; scan < scans.size(); ++scan) {
    std::vector<int>& marked = found[0][scan];
    marked.insert(marked.end(), found[1][scan].begin(), found[1][scan].end());
    sort_and_unite(marked);
  }
  return std::move(found[0]);
}

}  // namespace raymoval::raymoval_plus_method
