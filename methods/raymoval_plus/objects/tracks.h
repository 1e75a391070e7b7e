// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "methods/raymoval_plus/objects/object_summary.h"

namespace raymoval::raymoval_plus_method {

/// One object in the scans in which it was found.
struct Track {
  struct Node {
    std::size_t scan;
    ObjectSummary object;
  };
  std::vector<Node> nodes;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Metres a scan, in the order followed.
};

/// Dynamic objects that a track needs: one or two may be chance.
inline constexpr int kLeastDynamic = 3;
/// How many of a track's objects are dynamic.
int dynamic_objects(const Track& track, const Parameters& parameters);
/// The number of scans from one to another, whichever is first.
int scans_between(std::size_t a, std::size_t b);

/// How an object moves.
struct Motion {
  double length;  ///< Of the object, metres.
  double speed;   ///< Metres a scan.
};
/// So many scans more may agree with an object than its length and speed explain: one when it comes
/// and one when it leaves are in part.
inline constexpr double kScansMore = 2.0;
/// The number of scans that agree with the place of an object that moves on, by its length and
/// speed.
double scans_passing(const ObjectSummary& object, const Motion& motion,
                     const Parameters& parameters);
/// The number of scans that may agree with it for its length and speed to explain them.
double scans_explained(const ObjectSummary& object, const Motion& motion,
                       const Parameters& parameters);
/// Whether scans agree on an object no longer than its length and speed explain.
bool is_explained(const ObjectSummary& object, const Motion& motion, const Parameters& parameters);

/// An object may be so fast before its speed is known, metres a second.
inline constexpr double kFirstSpeed = 40.0;

/// Scans that a track may miss, while something passes before the object.
inline constexpr int kLongestGap = 2;

/// What the next object of a track may be.
struct TrackGate {
  /// How far it may be from where it is expected, beside a share of the way that it should have
  /// gone; ...
  double metres;
  double acceleration;  ///< ... metres a second squared: so much more, times the square of the time
                        ///< between.
  int patience;         ///< The scans that a track may miss while its object stands.
};
/// For what hardly changes its speed between two scans.
inline constexpr TrackGate kGate{0.6, 0.0, kLongestGap};
/// For what brakes or speeds up between scans that are far apart in time: by 3 m/s^2, which drivers
/// seldom exceed. What is known of its speed is a mean of its last steps, so that it is half as
/// much again. Others may pass before it while it stands.
inline constexpr TrackGate kWideGate{0.6, 4.5, 10};

/// How objects are followed.
struct TrackRules {
  /// So fast may an object be in its first step, when nothing is known of its speed yet; metres a
  /// second. Slow ones may be followed anyhow.
  double first_speed = 0.0;
  TrackGate gate = kGate;
  bool also_undivided = false;  ///< Whether what was divided may be followed as it was before.
};

/// Follows dynamic objects from scan to scan. Scans come in ascending or in descending order.
class ObjectTracker {
 public:
  explicit ObjectTracker(const Parameters& parameters, const TrackRules& rules = {})
      : parameters_(parameters), rules_(rules) {}

  /// Takes the objects of the next scan.
  void follow(std::size_t scan, const std::vector<ObjectSummary>& objects);
  /// All tracks so far. Those that ended with too few dynamic objects are forgotten.
  [[nodiscard]] std::vector<Track> finish();
  /// Forgets the tracks that ended.
  void forget_ended() { ended_.clear(); }

 private:
  /// How far an object may be from where the track is expected after so many scans and seconds.
  [[nodiscard]] double gate(const Track& track, int scans, double seconds) const;
  /// The same at most, also for what may be fast; metres. @param time_s of the object
  [[nodiscard]] double farthest(const Track& track, int scans, double time_s) const;
  /// The distance of an object from where the track is expected after so many scans, metres, if it
  /// can be the same object.
  [[nodiscard]] std::optional<double> mismatch(const Track& track, const ObjectSummary& found,
                                               int scans) const;
  [[nodiscard]] bool may_follow(const ObjectSummary& object) const {
    return rules_.also_undivided || !object.is_undivided;
  }
  void end_tracks(std::size_t scan);

  Parameters parameters_;
  TrackRules rules_;
  std::vector<Track> active_, ended_;
};

}  // namespace raymoval::raymoval_plus_method
