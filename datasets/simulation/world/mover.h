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

/// The path and speed of a mover: along a road, or along given points.
struct Route {
  std::string road;                     ///< Empty = `points`.
  double lane_m = 0.0;                  ///< To the left of the road's middle, seen along the road.
  bool reverse = false;                 ///< Against the direction of the road.
  std::vector<Eigen::Vector2d> points;  ///< In the plane of the world, metres.
  double start_m = 0.0;                 ///< Distance along the route at time 0.
  SpeedProfile speed;
  /// Metres above the ground, over the distance along the route: a ramp and the storey it leads to.
  SpeedProfile lift;
};

/// The time span in which an object is in the world, seconds.
struct Presence {
  double from_s = -std::numeric_limits<double>::infinity();
  double until_s = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool holds(double time) const { return time >= from_s && time < until_s; }
  [[nodiscard]] bool is_limited() const { return std::isfinite(from_s) || std::isfinite(until_s); }
};

/// A prepared route: gives the position at a time, and the pose on the ground there.
class Track {
 public:
  /// @throws ConfigurationError if the route's road does not exist.
  Track(const Route& route, const Ground& ground);
  [[nodiscard]] double along(double time) const { return start_ + speed_.distance(time); }
  [[nodiscard]] double speed(double time) const { return speed_.speed(time); }
  [[nodiscard]] const SpeedProfile& profile() const { return speed_; }
  [[nodiscard]] double length() const { return path_.length(); }
  [[nodiscard]] bool closed() const { return path_.closed(); }
  /// Whether the route exists at distance `s`. An open route exists from its beginning to its end.
  [[nodiscard]] bool reaches(double s) const;
  /// Frame on the ground at distance `s`: x along the path, z up, with the tilt of wheels
  /// `wheelbase` and `gauge` metres apart.
  [[nodiscard]] Eigen::Isometry3d frame(double s, double left, double wheelbase,
                                        double gauge) const;

 private:
  Path path_;
  const Ground* ground_;
  double lane_;
  bool reverse_;
  double start_;
  SpeedProfile speed_;
  SpeedProfile lift_;
};

/// An object that follows a track.
class Mover {
 public:
  Mover(std::string kind, Body body, Track track, double left, std::uint16_t instance,
        Presence presence = {});

  /// Whether the mover is in the world: false before and after its route, and outside its presence.
  [[nodiscard]] bool present(double time) const;
  [[nodiscard]] Eigen::Isometry3d pose(double time) const;
  /// Its parts at `time`, present or not.
  void place(double time, std::vector<PlacedPart>& parts) const;
  /// Sets the label: an object that moves, appears or disappears at any time from 0 to `duration`
  /// (seconds) is labelled moving for the whole sequence.
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
