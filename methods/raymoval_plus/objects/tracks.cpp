// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/tracks.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step.
/// An object of a track of at least so many stands if it moves by less than so many metres a scan,
/// by which the centre of a standing thing shifts.
constexpr std::size_t kLeastStanding = 3;
constexpr double kStandingMotion = 0.05;
/// An object may be so fast before its speed is known, metres a second.
constexpr double kFirstSpeed = 40.0;
/// Scans that a track may miss, while something passes before the object; and while the object
/// stands.
constexpr int kLongestGap = 2, kLongestGapStanding = 10;
/// How far an object may be from where its track is expected, metres; and by how much more, times
/// the square of the seconds between: by 3 m/s^2, which drivers seldom exceed. What is known of its
/// speed is a mean of its last steps, so that it is half as much again.
constexpr double kGate = 0.6, kAcceleration = 4.5;
/// An object may be farther from where its track is expected by this share of the way that it
/// should have gone: things speed up, brake, turn, and are seen in part.
constexpr double kGateShare = 0.35;
/// Seconds for which a gate grows. After more, it would take in anything.
constexpr double kLongestStep = 0.5;
/// Along each axis its box may change by so many metres, and by this share of the larger one.
constexpr double kResize = 0.6, kResizeShare = 0.3;

void extend(Track& track, const Track::Node& node) {
  const Track::Node& last = track.nodes.back();
  const Eigen::Vector3d moved =
      (node.object.center - last.object.center) / scans_between(last.scan, node.scan);
  // The mean with what was known: each step before counts half as much as the next one.
  track.velocity =
      track.nodes.size() == 1 ? moved : Eigen::Vector3d(0.5 * (track.velocity + moved));
  track.nodes.push_back(node);
}

/// Where the object of a track is expected after so many scans, world frame, metres.
Eigen::Vector3d expected_center(const Track& track, int scans) {
  return track.nodes.back().object.center + track.velocity * scans;
}

/// How far an object may be from where the track is expected after so many scans and seconds.
double gate(const Track& track, int scans, double seconds) {
  const double step = std::min(seconds, kLongestStep);
  return kGate + kAcceleration * step * step + kGateShare * track.velocity.norm() * scans;
}

/// The same at most, also for what may be fast; metres. @param time_s of the object
double farthest(const Track& track, int scans, double time_s) {
  const double widest = gate(track, scans, kLongestStep);
  if (track.nodes.size() > 1) return widest;
  return std::max(widest, kFirstSpeed * std::abs(time_s - track.nodes[0].object.time_s));
}

/// Whether the object of a track stands.
bool stands(const Track& track) {
  return track.nodes.size() >= kLeastStanding && track.velocity.norm() < kStandingMotion;
}

}  // namespace

int scans_between(std::size_t a, std::size_t b) {
  return static_cast<int>(std::abs(static_cast<long>(a) - static_cast<long>(b)));
}

int dynamic_objects(const Track& track, const Parameters& parameters) {
  return static_cast<int>(
      std::count_if(track.nodes.begin(), track.nodes.end(),
                    [&](const Track::Node& node) { return is_dynamic(node.object, parameters); }));
}

double scans_passing(const ObjectSummary& object, const Motion& motion,
                     const Parameters& parameters) {
  const double reach = parameters.hit_distance + Parameters::distance_slope * object.range;
  return (motion.length + 2.0 * reach + parameters.voxel_size) / motion.speed;
}

bool is_explained(const ObjectSummary& object, const Motion& motion, const Parameters& parameters) {
  return object.hits <=
         parameters.track_slack * scans_passing(object, motion, parameters) + kScansMore;
}

std::optional<double> ObjectTracker::mismatch(const Track& track, const ObjectSummary& found,
                                              int scans) const {
  const ObjectSummary& last = track.nodes.back().object;
  const double distance = (found.center - expected_center(track, scans)).head<2>().norm();
  const double seconds = std::abs(found.time_s - last.time_s);
  if (distance > gate(track, scans, seconds)) {
    // Nothing is known of the speed of what was seen once, but what is fast is new where it is.
    const bool may_be_fast = track.nodes.size() == 1 && distance <= kFirstSpeed * seconds &&
                             is_explained(found, {last.width(), distance / scans}, parameters_);
    if (!may_be_fast) return std::nullopt;
  }
  const Eigen::Array3d size = last.high - last.low, found_size = found.high - found.low;
  if (((size - found_size).abs() > kResize + kResizeShare * size.max(found_size)).any()) {
    return std::nullopt;
  }
  return distance;
}

void ObjectTracker::follow(std::size_t scan, const std::vector<ObjectSummary>& objects) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  const double time_s = objects.empty() ? 0.0 : objects.front().time_s;  // That of all of them.
  for (std::size_t t = 0; t < active_.size(); ++t) {
    const int scans = scans_between(active_[t].nodes.back().scan, scan);
    // Most objects are too far away along one axis alone.
    const double x = expected_center(active_[t], scans).x();
    const double reach = farthest(active_[t], scans, time_s);
    for (std::size_t k = 0; k < objects.size(); ++k) {
      if (std::abs(objects[k].center.x() - x) > reach) continue;
      if (const auto distance = mismatch(active_[t], objects[k], scans)) {
        pairs.emplace_back(*distance, t, k);
      }
    }
  }
  // The nearest pair first; each object belongs to one track at most.
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::uint8_t> is_used(objects.size(), 0), is_extended(active_.size(), 0);
  for (const auto& [distance, t, k] : pairs) {
    if (is_used[k] != 0 || is_extended[t] != 0) continue;
    is_used[k] = is_extended[t] = 1;
    extend(active_[t], {scan, objects[k]});
  }
  end_tracks(scan);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (is_used[k] == 0 && is_dynamic(objects[k], parameters_)) {
      active_.push_back({{{scan, objects[k]}}});
    }
  }
}

void ObjectTracker::end_tracks(std::size_t scan) {
  std::vector<Track> kept;
  for (Track& track : active_) {
    const int patience = stands(track) ? kLongestGapStanding : kLongestGap;
    if (scans_between(track.nodes.back().scan, scan) <= patience) {
      kept.push_back(std::move(track));
    } else if (dynamic_objects(track, parameters_) >= kLeastDynamic) {
      ended_.push_back(std::move(track));
    }
  }
  active_ = std::move(kept);
}

std::vector<Track> ObjectTracker::finish() {
  for (Track& track : active_) ended_.push_back(std::move(track));
  active_.clear();
  return std::move(ended_);
}

}  // namespace raymoval::raymoval_plus_method
