// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/tracks.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace raymoval {
namespace {

constexpr int kLongestGap = 2;  // Scans that a track may miss.

struct Node {
  std::size_t scan, object;
};

struct Track {
  std::vector<Node> nodes;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Metres a scan, in the order followed.
};

class Follower {
 public:
  Follower(const std::vector<std::vector<ObjectSummary>>& scans,
           const RaymovalPlusParameters& parameters, bool backward)
      : scans_(scans), parameters_(parameters), backward_(backward) {}

  /// Follows every dynamic object through all scans.
  std::vector<Track> run() {
    for (std::size_t i = 0; i < scans_.size(); ++i) step(i);
    for (Track& track : active_) done_.push_back(std::move(track));
    return std::move(done_);
  }

  [[nodiscard]] const ObjectSummary& object(const Node& node) const {
    return scans_[node.scan][node.object];
  }

 private:
  [[nodiscard]] std::size_t scan_at(std::size_t step) const {
    return backward_ ? scans_.size() - 1 - step : step;
  }
  [[nodiscard]] int gap(const Track& track, std::size_t scan) const {
    const auto last = static_cast<long>(track.nodes.back().scan);
    return static_cast<int>(std::abs(static_cast<long>(scan) - last));
  }

  [[nodiscard]] bool is_dynamic(const ObjectSummary& object) const {
    return object.points > 0 &&
           object.dynamic >= parameters_.object_dynamic_share * object.points &&
           object.dynamic >= parameters_.object_points;
  }
  /// Distance from where the track is expected, or a negative number if it cannot be the same.
  [[nodiscard]] double mismatch(const Track& track, const ObjectSummary& found, int gap) const {
    if (found.points == 0) return -1.0;
    const ObjectSummary& last = object(track.nodes.back());
    const Eigen::Vector3d expected = last.center + track.velocity * gap;
    const double distance = (found.center - expected).head<2>().norm();
    const double gate = 0.6 + 0.35 * track.velocity.norm() * gap;
    if (distance > gate) return -1.0;
    const Eigen::Array3d size = last.high - last.low, found_size = found.high - found.low;
    if (((size - found_size).abs() > 0.6 + 0.3 * size.max(found_size)).any()) return -1.0;
    return distance;
  }

  void step(std::size_t number) {
    const std::size_t scan = scan_at(number);
    const std::vector<ObjectSummary>& objects = scans_[scan];
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t t = 0; t < active_.size(); ++t) {
      for (std::size_t k = 0; k < objects.size(); ++k) {
        const double distance = mismatch(active_[t], objects[k], gap(active_[t], scan));
        if (distance >= 0.0) pairs.emplace_back(distance, t, k);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::uint8_t> used(objects.size(), 0), extended(active_.size(), 0);
    for (const auto& [distance, t, k] : pairs) {
      if (used[k] != 0 || extended[t] != 0) continue;
      used[k] = extended[t] = 1;
      extend(active_[t], {scan, k});
    }
    retire(scan);
    for (std::size_t k = 0; k < objects.size(); ++k) {
      if (used[k] == 0 && is_dynamic(objects[k])) {
        active_.push_back({{{scan, k}}, Eigen::Vector3d::Zero()});
      }
    }
  }

  void extend(Track& track, const Node& node) {
    const Eigen::Vector3d moved =
        (object(node).center - object(track.nodes.back()).center) / gap(track, node.scan);
    track.velocity = track.nodes.size() == 1 ? moved : 0.5 * (track.velocity + moved);
    track.nodes.push_back(node);
  }

  void retire(std::size_t scan) {
    std::vector<Track> kept;
    for (Track& track : active_) {
      (gap(track, scan) > kLongestGap ? done_ : kept).push_back(std::move(track));
    }
    active_ = std::move(kept);
  }

  const std::vector<std::vector<ObjectSummary>>& scans_;
  const RaymovalPlusParameters& parameters_;
  bool backward_;
  std::vector<Track> active_, done_;

 public:
  /// Marks the objects of a track that moved and was dynamic for most of it.
  void mark(const Track& track, std::vector<std::vector<std::uint8_t>>& marks) const {
    std::size_t dynamic = 0;
    std::vector<double> widths;
    const ObjectSummary *first = nullptr, *last = nullptr;
    std::size_t first_scan = 0, last_scan = 0;
    for (const Node& node : track.nodes) {
      widths.push_back(object(node).width());
      if (!is_dynamic(object(node))) continue;
      ++dynamic;
      if (first == nullptr) {
        first = &object(node);
        first_scan = node.scan;
      }
      last = &object(node);
      last_scan = node.scan;
    }
    if (dynamic < 3 || static_cast<double>(dynamic) < parameters_.track_dynamic_share *
                                                          static_cast<double>(track.nodes.size())) {
      return;
    }
    std::nth_element(widths.begin(), widths.begin() + static_cast<long>(widths.size() / 2),
                     widths.end());
    const double length = widths[widths.size() / 2];
    const double moved = (last->center - first->center).head<2>().norm();
    if (moved < std::max(0.5, 0.25 * length)) return;
    const double scans = std::abs(static_cast<double>(last_scan) - static_cast<double>(first_scan));
    const double a_scan = moved / scans;
    for (const Node& node : track.nodes) {
      const ObjectSummary& here = object(node);
      if (is_dynamic(here)) continue;
      const double reach = parameters_.agree_constant + parameters_.agree_slope * here.range;
      const double explained = (length + 2.0 * reach + parameters_.voxel_size) / a_scan;
      if (here.agree_scans <= parameters_.track_slack * explained + 2.0)
        marks[node.scan][node.object] = 1;
    }
  }
};

}  // namespace

std::vector<std::vector<std::uint8_t>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans,
    const RaymovalPlusParameters& parameters) {
  std::vector<std::vector<std::uint8_t>> marks(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) marks[i].assign(scans[i].size(), 0);
  for (const bool backward : {false, true}) {
    Follower follower(scans, parameters, backward);
    for (const Track& track : follower.run()) follower.mark(track, marks);
  }
  return marks;
}

}  // namespace raymoval
