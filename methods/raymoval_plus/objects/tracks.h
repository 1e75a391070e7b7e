// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// What step 7 knows of a cluster of one scan; world frame, metres.
struct ObjectSummary {
  /// Bounding box.
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< Mean of the points.
  double time_s = 0.0;                               ///< Of its scan.
  float range = 0.0F;                                ///< Distance of the centre from the sensor.
  /// The number of scans that agree with a point, on average over the points that are not dynamic.
  float agree_scans = 0.0F;
  int points = 0;
  int dynamic = 0;            ///< How many points are dynamic.
  bool is_whole = false;      ///< The others stand on these, see `Cluster::is_whole`.
  bool is_undivided = false;  ///< It was divided, and so stands beside what it was divided into.
  int cluster = 0;            ///< Number within its scan.

  [[nodiscard]] double width() const { return (high - low).head<2>().norm(); }
};

/// Whether a cluster, or what is remembered of it, is one dynamic thing: whole, or with enough of
/// its points dynamic.
template <class Thing>
bool is_one_dynamic_thing(const Thing& thing, const Parameters& parameters) {
  return thing.is_whole || thing.dynamic >= parameters.object_dynamic_share * thing.points;
}

/// Whether an object is one dynamic thing and has enough dynamic points.
bool is_dynamic(const ObjectSummary& object, const Parameters& parameters);

/// One object in the scans in which it was found.
struct Track {
  struct Node {
    std::size_t scan;
    ObjectSummary object;
  };
  std::vector<Node> nodes;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Metres a scan, in the order followed.
};

/// An object may move by so many metres between two scans before its speed is known: 40 m/s at ten
/// scans a second.
inline constexpr double kFirstStep = 4.0;

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
inline constexpr TrackGate kGate{0.6, 0.0, 2};
/// For what brakes or speeds up between scans that are far apart in time: by 3 m/s^2, which drivers
/// seldom exceed. What is known of its speed is a mean of its last steps, so that it is half as
/// much again. Others may pass before it while it stands.
inline constexpr TrackGate kWideGate{0.6, 4.5, 10};

/// How objects are followed.
struct TrackRules {
  /// Metres a scan that an object may be faster than slow ones in its first step, of whose speed
  /// nothing is known yet.
  double first_step = 0.0;
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
  std::size_t scan_ = 0;
  std::vector<Track> active_, ended_;
};

/// The clusters of one scan that the objects of these tracks are, though their own rays do not say
/// so.
std::vector<int> marked_in(std::size_t scan, const std::vector<Track>& tracks,
                           const Parameters& parameters);

/// Step 7: the clusters of each scan that were seen moving before or after, though their own rays
/// do not say so. A track of dynamic objects passes through them, forward or backward in time. If
/// scans agree with them for too long for that, others that go account for the time.
std::vector<std::vector<int>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans, const Parameters& parameters,
    const RunContext& context);

}  // namespace raymoval::raymoval_plus_method
