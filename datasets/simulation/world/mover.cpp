// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/mover.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Track::Track(const Route& route, const Ground& ground)
    : path_(route.road.empty() ? Path(route.points, false) : ground.road(route.road).path),
      ground_(&ground),
      lane_(route.lane_m),
      reverse_(route.reverse),
      start_(route.start_m),
      speed_(route.speed),
      lift_(route.lift) {}

bool Track::reaches(double s) const {
  return closed() || (s >= 0.0 && s <= length());
}

Isometry3d Track::frame(double s, double left, double wheelbase, double gauge) const {
  const double on_path = reverse_ ? length() - s : s;
  const double offset = lane_ + (reverse_ ? -left : left);
  const Vector2d at = path_.at(on_path, offset);
  const Vector2d x = (reverse_ ? -1.0 : 1.0) * path_.direction(on_path);
  const Vector2d y(-x.y(), x.x());
  const auto height = [&](double forward, double side) {
    return ground_->height(at + forward * x + side * y) + lift_.speed(s + forward);
  };
  const double h = 0.5 * wheelbase;
  const double g = 0.5 * gauge;
  const double front = 0.5 * (height(h, g) + height(h, -g));
  const double back = 0.5 * (height(-h, g) + height(-h, -g));
  const double near = 0.5 * (height(h, g) + height(-h, g));
  const double far = 0.5 * (height(h, -g) + height(-h, -g));
  const Vector3d forward = Vector3d(x.x(), x.y(), (front - back) / (2.0 * h)).normalized();
  const Vector3d side(y.x(), y.y(), (near - far) / (2.0 * g));
  const Vector3d up = forward.cross(side).normalized();
  Isometry3d frame = Isometry3d::Identity();
  frame.linear().col(0) = forward;
  frame.linear().col(1) = up.cross(forward);
  frame.linear().col(2) = up;
  frame.translation() = Vector3d(at.x(), at.y(), 0.5 * (front + back));
  return frame;
}

Mover::Mover(std::string kind, Body body, Track track, double left, std::uint16_t instance,
             Presence presence)
    : kind_(std::move(kind)),
      body_(std::move(body)),
      track_(std::move(track)),
      left_(left),
      instance_(instance),
      presence_(presence) {
  set_label(0.0);
}

bool Mover::present(double time) const {
  return presence_.holds(time) && track_.reaches(track_.along(time));
}

Isometry3d Mover::pose(double time) const {
  return track_.frame(track_.along(time), left_, 0.6 * body_.length_m, 0.8 * body_.width_m);
}

Isometry3d Mover::part_motion(const BodyPart& part, double time) const {
  switch (part.joint) {
    case BodyPart::Joint::kFixed:
      break;
    case BodyPart::Joint::kCar:
      return track_.frame(track_.along(time) + part.along_m, left_, 5.0, 1.5);
    case BodyPart::Joint::kSwing: {
      const double vigour = std::min(1.0, track_.speed(time) / body_.pace_mps);
      const double turns = track_.along(time) / body_.stride_m + part.phase;
      const double angle = part.amplitude * vigour * std::sin(2.0 * std::numbers::pi * turns);
      return pose(time) * hinge(part.pivot.x(), part.pivot.y(), part.pivot.z(), angle);
    }
  }
  return pose(time);
}

void Mover::place(double time, std::vector<PlacedPart>& parts) const {
  for (const BodyPart& part : body_.parts) {
    parts.push_back({&part.mesh, part_motion(part, time), label_});
  }
}

void Mover::set_label(double duration) {
  constexpr double kStill = 0.05;  // metres
  constexpr int kOutcomeStyles = 400;
  const double start = track_.along(0.0);
  moves_ = presence_.from_s > 0.0 || presence_.until_s < duration;
  for (int i = 1; i <= kOutcomeStyles && !moves_; ++i) {
    moves_ = std::abs(track_.along(duration * i / kOutcomeStyles) - start) > kStill;
  }
  const std::uint16_t semantic = moves_ ? body_.moving_label : body_.static_label;
  label_ = (static_cast<std::uint32_t>(instance_) << 16) | semantic;
}

}  // namespace raymoval::simulated
