// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// A cluster of one scan as the tracks see it; world frame, metres.
struct ObjectSummary {
  Eigen::Vector3d low, high;  ///< Bounding box.
  Eigen::Vector3d center;     ///< Mean of the points.
  float range = 0.0F;         ///< Distance of the centre from the sensor.
  float agree_scans = 0.0F;   ///< Mean number of scans that agree with the points not dynamic.
  int points = 0;
  int dynamic = 0;  ///< Points found dynamic.
  int cluster = 0;  ///< Number within its scan.

  [[nodiscard]] double width() const { return (high - low).head<2>().norm(); }
};

struct TrackNode {
  std::size_t scan;
  ObjectSummary object;
};

struct Track {
  std::vector<TrackNode> nodes;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Metres a scan, in the order followed.
};

/// Follows dynamic objects from scan to scan, scans given in ascending or descending order.
class Follower {
 public:
  explicit Follower(const RaymovalPlusParameters& parameters) : parameters_(parameters) {}

  /// Takes the next scan's objects.
  void step(std::size_t scan, const std::vector<ObjectSummary>& objects);
  /// Tracks that ended or are still followed; those without enough dynamic objects are forgotten.
  [[nodiscard]] std::vector<Track> finish();
  /// Clusters of the last scan that were seen moving before, though their own rays do not say so.
  [[nodiscard]] std::vector<int> marked_now() const;

 private:
  [[nodiscard]] double mismatch(const Track& track, const ObjectSummary& found, int gap) const;
  void extend(Track& track, TrackNode node) const;
  void retire(std::size_t scan);

  RaymovalPlusParameters parameters_;
  std::size_t scan_ = 0;
  std::vector<Track> active_, done_;
};

/// Clusters of each scan that were seen moving before or after, though their own rays do not say
/// so: those that a track of dynamic objects passes through, forward or backward in time.
std::vector<std::vector<int>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans, const RaymovalPlusParameters& parameters);

}  // namespace raymoval
