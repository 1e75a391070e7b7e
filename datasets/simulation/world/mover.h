// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "datasets/simulation/shapes/bodies.h"
#include "datasets/simulation/world/ground.h"
#include "datasets/simulation/world/path.h"

namespace raymoval::simulated {

/// A rigid mesh of the world at one instant.
struct PlacedPart {
  const Mesh* mesh = nullptr;
  Eigen::Isometry3d T_world_part = Eigen::Isometry3d::Identity();
  std::uint32_t label = 0;  ///< Word of all its triangles; 0 = each its own.
};

/// Where something goes and how fast: along a road, or along points of its own.
struct Route {
  std::string road;                     ///< Empty = `points`.
  double lane_m = 0.0;                  ///< To the left of the road's middle, seen along the road.
  bool reverse = false;                 ///< Against the direction of the road.
  std::vector<Eigen::Vector2d> points;  ///< In the plane of the world, metres.
  double start_m = 0.0;                 ///< Distance along the route at time 0.
  SpeedProfile speed;
};

/// When something is in the world at all, seconds.
struct Presence {
  double from_s = -std::numeric_limits<double>::infinity();
  double until_s = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool holds(double time) const { return time >= from_s && time < until_s; }
  [[nodiscard]] bool is_limited() const { return std::isfinite(from_s) || std::isfinite(until_s); }
};

/// A route made ready: knows where one is at a time and how one stands on the ground there.
class Track {
 public:
  /// @throws ConfigurationError if the route's road does not exist.
  Track(const Route& route, const Ground& ground);
  [[nodiscard]] double along(double time) const { return start_ + speed_.distance(time); }
  [[nodiscard]] double speed(double time) const { return speed_.speed(time); }
  [[nodiscard]] const SpeedProfile& profile() const { return speed_; }
  [[nodiscard]] double length() const { return path_.length(); }
  [[nodiscard]] bool closed() const { return path_.closed(); }
  /// Does the route exist at distance `s`? An open one ends; a standing start before it does not.
  [[nodiscard]] bool reaches(double s) const;
  /// Frame on the ground at distance `s`: x along the way, z up, tilted as wheels `wheelbase` and
  /// `gauge` metres apart stand.
  [[nodiscard]] Eigen::Isometry3d frame(double s, double left, double wheelbase,
                                        double gauge) const;

 private:
  Path path_;
  const Ground* ground_;
  double lane_;
  bool reverse_;
  double start_;
  SpeedProfile speed_;
};

/// Something that follows a track.
class Mover {
 public:
  Mover(std::string kind, Body body, Track track, double left, std::uint16_t instance,
        Presence presence = {});

  /// False before a route begins and after it ends, and outside its presence: the mover is not in
  /// the world then.
  [[nodiscard]] bool present(double time) const;
  [[nodiscard]] Eigen::Isometry3d pose(double time) const;
  /// Its parts at `time`, present or not.
  void place(double time, std::vector<PlacedPart>& parts) const;
  /// Gives the label: an object that moves at any time from 0 to `duration` (seconds), or that
  /// comes or goes unseen meanwhile, is labelled moving throughout.
  void set_label(double duration);

  [[nodiscard]] bool moves() const { return moves_; }
  [[nodiscard]] std::uint32_t label() const { return label_; }
  [[nodiscard]] std::uint16_t instance() const { return instance_; }
  [[nodiscard]] const std::string& kind() const { return kind_; }
  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] const Track& track() const { return track_; }

 private:
  [[nodiscard]] Eigen::Isometry3d part_motion(const BodyPart& part, double time) const;
  std::string kind_;
  Body body_;
  Track track_;
  double left_;
  std::uint16_t instance_;
  Presence presence_;
  std::uint32_t label_ = 0;
  bool moves_ = false;
};

}  // namespace raymoval::simulated
