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
/// Whether scans agree on an object no longer than its length and speed explain.
bool is_explained(const ObjectSummary& object, const Motion& motion, const Parameters& parameters);

/// Follows dynamic objects from scan to scan. Scans come in ascending or in descending order.
class ObjectTracker {
 public:
  explicit ObjectTracker(const Parameters& parameters) : parameters_(parameters) {}

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
  void end_tracks(std::size_t scan);

  Parameters parameters_;
  std::vector<Track> active_, ended_;
};

}  // namespace raymoval::raymoval_plus_method
