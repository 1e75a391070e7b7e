// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/tracks.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace raymoval {
namespace {

constexpr int kLongestGap = 2;    // Scans that a track may miss.
constexpr int kLeastDynamic = 3;  // Objects.

int gap_between(std::size_t a, std::size_t b) {
  return static_cast<int>(std::abs(static_cast<long>(a) - static_cast<long>(b)));
}

bool is_dynamic(const ObjectSummary& object, const RaymovalPlusParameters& parameters) {
  return object.dynamic >= parameters.object_dynamic_share * object.points &&
         object.dynamic >= parameters.object_points;
}

int dynamic_objects(const Track& track, const RaymovalPlusParameters& parameters) {
  return static_cast<int>(
      std::count_if(track.nodes.begin(), track.nodes.end(),
                    [&](const TrackNode& node) { return is_dynamic(node.object, parameters); }));
}

struct Motion {
  double length;  ///< Of the object, metres.
  double a_scan;  ///< Metres a scan.
};

/// How the object of a track moved; nothing if it is not known to have moved.
std::optional<Motion> motion_of(const Track& track, const RaymovalPlusParameters& parameters) {
  const int dynamic = dynamic_objects(track, parameters);
  if (dynamic < kLeastDynamic ||
      dynamic < parameters.track_dynamic_share * static_cast<double>(track.nodes.size())) {
    return std::nullopt;
  }
  std::vector<double> widths;
  const TrackNode *first = nullptr, *last = nullptr;
  for (const TrackNode& node : track.nodes) {
    widths.push_back(node.object.width());
    if (!is_dynamic(node.object, parameters)) continue;
    if (first == nullptr) first = &node;
    last = &node;
  }
  const auto median = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), median, widths.end());
  const double moved = (last->object.center - first->object.center).head<2>().norm();
  if (moved < std::max(0.5, 0.25 * *median)) return std::nullopt;
  return Motion{*median, moved / gap_between(first->scan, last->scan)};
}

/// Scans agree on the object no longer than its length and speed explain.
bool is_explained(const ObjectSummary& object, const Motion& motion,
                  const RaymovalPlusParameters& parameters) {
  const double reach = parameters.agree_constant + parameters.agree_slope * object.range;
  const double scans = (motion.length + 2.0 * reach + parameters.voxel_size) / motion.a_scan;
  return object.agree_scans <= parameters.track_slack * scans + 2.0;
}

}  // namespace

/// Distance from where the track is expected, or a negative number if it cannot be the same.
double Follower::mismatch(const Track& track, const ObjectSummary& found, int gap) const {
  const ObjectSummary& last = track.nodes.back().object;
  const Eigen::Vector3d expected = last.center + track.velocity * gap;
  const double distance = (found.center - expected).head<2>().norm();
  const double gate = 0.6 + 0.35 * track.velocity.norm() * gap;
  if (distance > gate) return -1.0;
  const Eigen::Array3d size = last.high - last.low, found_size = found.high - found.low;
  if (((size - found_size).abs() > 0.6 + 0.3 * size.max(found_size)).any()) return -1.0;
  return distance;
}

void Follower::step(std::size_t scan, const std::vector<ObjectSummary>& objects) {
  scan_ = scan;
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t t = 0; t < active_.size(); ++t) {
    const int gap = gap_between(active_[t].nodes.back().scan, scan);
    for (std::size_t k = 0; k < objects.size(); ++k) {
      const double distance = mismatch(active_[t], objects[k], gap);
      if (distance >= 0.0) pairs.emplace_back(distance, t, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::uint8_t> used(objects.size(), 0), extended(active_.size(), 0);
  for (const auto& [distance, t, k] : pairs) {
    if (used[k] != 0 || extended[t] != 0) continue;
    used[k] = extended[t] = 1;
    extend(active_[t], {scan, objects[k]});
  }
  retire(scan);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (used[k] == 0 && is_dynamic(objects[k], parameters_)) {
      active_.push_back({{{scan, objects[k]}}, Eigen::Vector3d::Zero()});
    }
  }
}

void Follower::extend(Track& track, TrackNode node) const {
  const TrackNode& last = track.nodes.back();
  const Eigen::Vector3d moved =
      (node.object.center - last.object.center) / gap_between(last.scan, node.scan);
  if (track.nodes.size() == 1) {
    track.velocity = moved;
  } else {
    track.velocity = 0.5 * (track.velocity + moved);
  }
  track.nodes.push_back(node);
}

void Follower::retire(std::size_t scan) {
  std::vector<Track> kept;
  for (Track& track : active_) {
    if (gap_between(track.nodes.back().scan, scan) <= kLongestGap) {
      kept.push_back(std::move(track));
    } else if (dynamic_objects(track, parameters_) >= kLeastDynamic) {
      done_.push_back(std::move(track));
    }
  }
  active_ = std::move(kept);
}

std::vector<Track> Follower::finish() {
  for (Track& track : active_) done_.push_back(std::move(track));
  active_.clear();
  return std::move(done_);
}

std::vector<int> Follower::marked_now() const {
  std::vector<int> marked;
  for (const Track& track : active_) {
    const TrackNode& node = track.nodes.back();
    if (node.scan != scan_ || is_dynamic(node.object, parameters_)) continue;
    const auto motion = motion_of(track, parameters_);
    if (motion && is_explained(node.object, *motion, parameters_)) {
      marked.push_back(node.object.cluster);
    }
  }
  return marked;
}

std::vector<std::vector<int>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans,
    const RaymovalPlusParameters& parameters) {
  std::vector<std::vector<int>> marked(scans.size());
  for (const bool backward : {false, true}) {
    Follower follower(parameters);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const std::size_t scan = backward ? scans.size() - 1 - i : i;
      follower.step(scan, scans[scan]);
    }
    for (const Track& track : follower.finish()) {
      const auto motion = motion_of(track, parameters);
      if (!motion) continue;
      for (const auto& [scan, object] : track.nodes) {
        if (is_dynamic(object, parameters) || !is_explained(object, *motion, parameters)) continue;
        marked[scan].push_back(object.cluster);
      }
    }
  }
  return marked;
}

}  // namespace raymoval
