// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/journeys.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "core/sampling.h"
#include "methods/raymoval_plus/evidence/evidence.h"
#include "methods/raymoval_plus/objects/taken_places.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step.
/// An object moved if its centre did by so many metres, and by this share of its length: the centre
/// of a standing thing shifts by less when other sides of it come into sight.
constexpr double kLeastMotion = 0.5, kLeastMotionShare = 0.25;
/// An object is in its place while it moved by no more than this share of its width.
constexpr double kPlaceShare = 1.0;
/// Scans may agree with an object that stands so many times as long as it was followed there: other
/// sides of it come into sight, or something passes before it, and its track is lost.
constexpr double kStaySlack = 2.0;
/// With what stands there anyway, at least this share of the scans agree in which it would have to
/// be gone.
constexpr double kLeastPresent = 0.25;
/// Where nothing moved, scans must agree for so many times as long before a track or after it, for
/// what stands there to stand anyway: who stood before his track was lost and begins anew was there
/// as well.
constexpr double kLongerStay = 2.0;
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

/// Whether scans agree on an object no longer than it was followed while it stood.
/// @param stay where it is then
bool is_explained_by_stay(const ObjectSummary& object, const Stay& stay) {
  return object.agree_scans <= kStaySlack * stay.scans() + kScansMore;
}

/// Whether enough of the objects of a track that stands are dynamic: it came or leaves.
bool came_or_leaves(const Track& track, const Parameters& parameters) {
  static const double kCame = getenv("CAME") ? atof(getenv("CAME")) : 0.25;
  return dynamic_objects(track, parameters) >= kCame * static_cast<double>(track.nodes.size());
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

/// Whether something stands where an object does, no matter whether the object is there: it is the
/// pole or the tree whose track somebody who passed took over. Scans agree with it long before the
/// object would have come, or long after it would have left.
bool stands_anyway(const ObjectSummary& object, const Stay& stay, const Journey& journey,
                   const Parameters& parameters) {
  if (parameters.settled_scans == 0) return false;
  if (!is_hardly_seen_through(object)) return false;
  const double before = static_cast<double>(stay.first) - object.first_agree;
  const double after = object.last_agree - static_cast<double>(stay.last);
  const double absent = std::max(before, 0.0) + std::max(after, 0.0);
  if (object.agree_scans - stay.scans() < kLeastPresent * absent) return false;
  const bool was_before = before > parameters.settled_scans;
  const bool is_after = after > parameters.settled_scans;
  const double long_time = parameters.settled_scans * (journey.motion ? 1.0 : kLongerStay);
  const bool came = journey.dynamic.first <= stay.first && before > long_time;
  const bool left = journey.dynamic.last >= stay.last && after > long_time;
  return came || left || (was_before && is_after);
}

/// Whether one of a track's objects belongs to what moved, came or leaves: scans agree on it no
/// longer than its length and speed explain, or than it was followed while it stood.
bool belongs(const Track& track, std::size_t at, const Journey& journey,
             const Parameters& parameters) {
  const ObjectSummary& object = track.nodes[at].object;
  // What came or leaves, and stands else, is in one place all the time.
  const Stay stay =
      journey.motion ? stay_of(track, at) : stay_between(track.nodes.front(), track.nodes.back());
  static const double kShare = getenv("BSH") ? atof(getenv("BSH")) : 0.25;
  const double slack = 3.0 + kShare * stay.scans();
  if (object.width() > journey.widest) return false;
  return object.first_agree >= static_cast<double>(stay.first) - slack &&
         object.last_agree <= static_cast<double>(stay.last) + slack;
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

/// An object of a track on which scans agree for longer than its motion explains.
struct Passing {
  std::size_t scan;
  ObjectSummary object;
  double explained;  ///< By its motion: a number of scans.
};

/// What tracks say of the objects.
struct Findings {
  std::vector<std::vector<int>> marked;  ///< Clusters of each scan.
  std::vector<Passing> passing;
};

/// Adds what one track says.
void judge(const Track& track, const Parameters& parameters, Findings& findings) {
  const auto journey = journey_of(track, parameters);
  if (!journey) return;
  for (std::size_t k = 0; k < track.nodes.size(); ++k) {
    const auto& [scan, object] = track.nodes[k];
    if (is_dynamic(object, parameters)) continue;
    static const double kNever = getenv("NEVER") ? atof(getenv("NEVER")) : -1, kMany = getenv("MANY") ? atof(getenv("MANY")) : 10;
    if (object.outside < kNever * object.points && object.agree_scans >= kMany) continue;
    if (belongs(track, k, *journey, parameters)) {
      findings.marked[scan].push_back(object.cluster);
      continue;
    }
    const auto& motion = journey->motion;
    if (getenv("NOPASS") != nullptr) continue;
    if (!motion || !goes_on(track, k, *motion, parameters)) continue;
    findings.passing.push_back({scan, object, scans_explained(object, *motion, parameters)});
  }
}

/// All ways to follow objects. What is fast is lost without a long first step, what brakes between
/// two scans without a wide gate, and what is divided in some scans and not in others if it may not
/// be followed as it was before. With these, a track may take a neighbour, or a part, for the
/// object that it lost, and then both are lost. So objects are followed with and without.
std::vector<TrackRules> all_rules() {
  std::vector<TrackRules> rules;
  if (getenv("ONERULE") != nullptr) return {{kFirstSpeed, atoi(getenv("ONERULE")) % 2 == 0 ? kGate : kWideGate, atoi(getenv("ONERULE")) / 2 == 1}};
  for (const bool also_undivided : {false, true}) {
    for (const TrackGate& gate : {kGate, kWideGate}) {
      for (const double first_speed : {0.0, kFirstSpeed}) {
        rules.push_back({first_speed, gate, also_undivided});
      }
    }
  }
  return rules;
}

/// What tracks say by all rules, forward and backward in time.
Findings follow_all(const std::vector<std::vector<ObjectSummary>>& scans,
                    const Parameters& parameters, int threads) {
  const std::vector<TrackRules> rules = all_rules();
  std::vector<Findings> by_rules(2 * rules.size());
  parallel_for(threads, by_rules.size(), 1, [&](std::size_t i) {
    by_rules[i].marked.resize(scans.size());
    const ObjectTracker tracker(parameters, rules[i / 2]);
    for (const Track& track : followed(scans, i % 2 == 1, tracker)) {
      judge(track, parameters, by_rules[i]);
    }
  });
  Findings all{std::vector<std::vector<int>>(scans.size()), {}};
  for (const Findings& some : by_rules) {
    for (std::size_t scan = 0; scan < scans.size(); ++scan) {
      all.marked[scan].insert(all.marked[scan].end(), some.marked[scan].begin(),
                              some.marked[scan].end());
    }
    all.passing.insert(all.passing.end(), some.passing.begin(), some.passing.end());
  }
  for (std::vector<int>& clusters : all.marked) sort_and_unite(clusters);
  return all;
}

/// The places of all objects that are dynamic or marked.
TakenPlaces taken_places(const std::vector<std::vector<ObjectSummary>>& scans,
                         const std::vector<std::vector<int>>& marked,
                         const Parameters& parameters) {
  TakenPlaces places;
  for (std::size_t scan = 0; scan < scans.size(); ++scan) {
    for (const ObjectSummary& object : scans[scan]) {
      const bool is_marked =
          std::binary_search(marked[scan].begin(), marked[scan].end(), object.cluster);
      if (is_marked || is_dynamic(object, parameters)) places.add(scan, object);
    }
  }
  places.sort();
  return places;
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
  Findings findings = follow_all(scans, parameters, context.threads);
  // Where others stood, scans agree on what passes for as long as these stood there.
  const TakenPlaces places = taken_places(scans, findings.marked, parameters);
  if (getenv("NOTAKEN") == nullptr) for (const auto& [scan, object, explained] : findings.passing) {
    if (object.agree_scans > explained + places.scans_at(object, parameters.voxel_size)) continue;
    findings.marked[scan].push_back(object.cluster);
  }
  for (std::vector<int>& clusters : findings.marked) sort_and_unite(clusters);
  return std::move(findings.marked);
}

}  // namespace raymoval::raymoval_plus_method
