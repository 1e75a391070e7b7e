// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/ego.h"

#include <cmath>
#include <numbers>

#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kBoomLength = 4.6;
constexpr double kStickLength = 2.4;
const Vector3d kBoomFoot(0.3, -0.35, 1.7);  // in the frame of the upper carriage
constexpr std::uint32_t kArmInstance = 0xFFFE;

Mesh make_hull(const std::string& body) {
  Mesh mesh;
  // Polished: KITTI's car returns hardly any point; it only hides the road.
  const Paint dark{Material::kPolish, kLabelOutlier};
  if (body == "car") {
    add_extrusion(mesh, dark,
                  {Vector2d(-2.1, 0.3), Vector2d(2.4, 0.3), Vector2d(2.4, 0.72),
                   Vector2d(1.35, 0.90), Vector2d(-2.1, 0.98)},
                  1.7);
    add_extrusion(
        mesh, dark,
        {Vector2d(-1.4, 0.9), Vector2d(1.0, 0.9), Vector2d(0.4, 1.28), Vector2d(-0.85, 1.3)}, 1.2);
  } else if (body == "excavator") {
    add_box(mesh, dark, {-1.9, -1.25, 1.0}, {0.9, 1.25, 1.75});
    add_box(mesh, dark, {-1.9, -1.2, 1.75}, {-0.8, 1.2, 2.1});
    add_box(mesh, {Material::kGlass, kLabelOutlier}, {-0.2, 0.2, 1.75}, {1.0, 1.2, 2.75});
  }
  return mesh;
}

/// A bent boom, a stick and a bucket, each along x from its own hinge.
Mesh make_boom() {
  Mesh mesh;
  const Paint paint{Material::kBrightPaint, 0};
  add_tube(mesh, paint, {0, 0, 0}, {0.45 * kBoomLength, 0, 0.55}, 0.24, 0.30, 4);
  add_tube(mesh, paint, {0.45 * kBoomLength, 0, 0.55}, {kBoomLength, 0, 0}, 0.30, 0.18, 4);
  add_tube(mesh, {Material::kMetal, 0}, {0.3, 0.2, -0.5}, {1.9, 0.2, 0.3}, 0.07, 0.05, 7);
  add_tube(mesh, {Material::kMetal, 0}, {1.9, 0, 0.9}, {4.2, 0, 0.45}, 0.08, 0.05, 7);
  return mesh;
}

Mesh make_stick() {
  Mesh mesh;
  const Paint paint{Material::kBrightPaint, 0};
  add_tube(mesh, paint, {-0.5, 0, 0.2}, {0.2, 0, 0}, 0.12, 0.22, 4);
  add_tube(mesh, paint, {0.2, 0, 0}, {kStickLength, 0, 0}, 0.22, 0.13, 4);
  return mesh;
}

Mesh make_bucket() {
  Mesh mesh;
  const Paint steel{Material::kMetal, 0};
  const double w = 0.55;
  const std::array<Vector2d, 5> shell = {Vector2d(0.0, 0.25), Vector2d(0.75, 0.3),
                                         Vector2d(1.15, -0.1), Vector2d(1.1, -0.65),
                                         Vector2d(0.8, -1.0)};
  for (std::size_t i = 0; i + 1 < shell.size(); ++i) {
    add_quad(mesh, steel, {shell[i].x(), -w, shell[i].y()},
             {shell[i + 1].x(), -w, shell[i + 1].y()}, {shell[i + 1].x(), w, shell[i + 1].y()},
             {shell[i].x(), w, shell[i].y()});
    for (const double side : {-w, w}) {
      const auto a = mesh.vertex({0.25, side, -0.2});
      mesh.vertex({shell[i].x(), side, shell[i].y()});
      mesh.vertex({shell[i + 1].x(), side, shell[i + 1].y()});
      mesh.triangle(a, a + 1, a + 2, steel);
    }
  }
  return mesh;
}

/// A bounded wobble of about `size`: a sum of a few sines without a common period.
double wobble(double time, double size, double phase) {
  return size * (0.5 * std::sin(2 * kPi * 1.13 * time + phase) +
                 0.35 * std::sin(2 * kPi * 2.71 * time + 2.1 * phase) +
                 0.25 * std::sin(2 * kPi * 11.3 * time + 3.7 * phase));
}

/// Motion of a sensor that a walking person carries, about a point on the ground: up and down with
/// each step, aside and rolling with each second step, and slowly turning.
Isometry3d gait(const EgoSpec& spec, double time) {
  const double step = 2.0 * kPi * spec.step_hz * time;
  // No two steps are alike.
  const double vigour = 0.8 + 0.2 * std::sin(0.37 * step + 0.6);
  const double roll = spec.sway_rad * vigour * std::sin(0.5 * step + 0.4);
  const double pitch = 0.6 * spec.sway_rad * vigour * std::sin(step + 1.3);
  const double yaw = spec.sway_rad * (std::sin(2.0 * kPi * 0.23 * time + 0.9) +
                                      0.6 * std::sin(2.0 * kPi * 0.61 * time));
  Isometry3d motion = Isometry3d::Identity();
  motion.translation() =
      Vector3d(0.3 * spec.sway_m * std::sin(step + 0.2), spec.sway_m * std::sin(0.5 * step),
               spec.sway_m * vigour * std::cos(step));
  motion.linear() =
      (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Vector3d::UnitX()))
          .toRotationMatrix();
  return motion;
}

/// Angles of an excavator at one instant, radians.
struct ArmAngles {
  double swing;   ///< Upper carriage about the vertical.
  double boom;    ///< Above the horizontal, at its foot.
  double stick;   ///< Relative to the boom.
  double bucket;  ///< Relative to the stick.
};

/// Angles `phase` (0 .. 1) of the way through dig, lift, swing, dump and swing back.
ArmAngles dig_cycle(double phase) {
  constexpr double d = kPi / 180.0;
  struct Key {
    double phase;
    ArmAngles angles;
  };
  static const std::array<Key, 7> keys = {{{0.00, {0, 12 * d, -105 * d, -40 * d}},
                                           {0.22, {0, 8 * d, -135 * d, -100 * d}},
                                           {0.36, {0, 38 * d, -120 * d, -110 * d}},
                                           {0.56, {75 * d, 45 * d, -95 * d, -100 * d}},
                                           {0.68, {78 * d, 42 * d, -75 * d, -10 * d}},
                                           {0.90, {0, 36 * d, -90 * d, -30 * d}},
                                           {1.00, {0, 12 * d, -105 * d, -40 * d}}}};
  phase -= std::floor(phase);
  std::size_t i = 1;
  while (i + 1 < keys.size() && phase > keys[i].phase) ++i;
  const Key& a = keys[i - 1];
  const Key& b = keys[i];
  const double u = (phase - a.phase) / (b.phase - a.phase);
  const double w = u * u * (3.0 - 2.0 * u);
  const auto blend = [w](double from, double to) { return from + w * (to - from); };
  return {blend(a.angles.swing, b.angles.swing), blend(a.angles.boom, b.angles.boom),
          blend(a.angles.stick, b.angles.stick), blend(a.angles.bucket, b.angles.bucket)};
}

}  // namespace

Ego::Ego(const EgoSpec& spec, const Ground& ground)
    : spec_(spec), track_(spec.route, ground), hull_(make_hull(spec.body)) {
  if (!has_arm()) return;
  boom_ = make_boom();
  stick_ = make_stick();
  bucket_ = make_bucket();
}

Isometry3d Ego::base(double time) const {
  Isometry3d base = track_.frame(track_.along(time), 0.0, 2.6, 1.5);
  if (has_arm()) base = base * placed(0, 0, 0, dig_cycle(time / spec_.dig_period_s).swing);
  Isometry3d shake = Isometry3d::Identity();
  shake.translation().z() = wobble(time, spec_.vibration_m, 0.3);
  shake.linear() = (Eigen::AngleAxisd(wobble(time, spec_.vibration_rad, 1.1), Vector3d::UnitY()) *
                    Eigen::AngleAxisd(wobble(time, spec_.vibration_rad, 2.3), Vector3d::UnitX()))
                       .toRotationMatrix();
  if (spec_.sway_m > 0.0 || spec_.sway_rad > 0.0) base = base * gait(spec_, time);
  return base * shake;
}

Isometry3d Ego::sensor_pose(double time) const {
  Isometry3d pose = usual_sensor_pose(time);
  if (spec_.mount.isZero(0.0)) return pose;
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(spec_.mount.z(), Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(spec_.mount.y(), Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(spec_.mount.x(), Vector3d::UnitX());
  const Eigen::Matrix3d vehicle = base(time).linear();
  pose.linear() = vehicle * turn * vehicle.transpose() * pose.linear();
  return pose;
}

Isometry3d Ego::usual_sensor_pose(double time) const {
  Isometry3d mount = Isometry3d::Identity();
  mount.translation() =
      Vector3d(spec_.sensor_forward_m, spec_.sensor_left_m, spec_.sensor_height_m);
  mount.linear() = (Eigen::AngleAxisd(spec_.sensor_pitch_rad, Vector3d::UnitY()) *
                    Eigen::AngleAxisd(spec_.sensor_roll_rad, Vector3d::UnitX()))
                       .toRotationMatrix();
  return base(time) * mount;
}

void Ego::place(double time, std::vector<PlacedPart>& parts) const {
  const Isometry3d carriage = base(time);
  if (!hull_.empty()) parts.push_back({&hull_, carriage, 0});
  if (!has_arm()) return;
  const std::uint32_t label = (kArmInstance << 16) | kLabelMovingOtherVehicle;
  const ArmAngles angles = dig_cycle(time / spec_.dig_period_s);
  const auto turned = [](double x, double y, double z, double up) {
    return Isometry3d(Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(-up, Vector3d::UnitY()));
  };
  const Isometry3d boom =
      carriage * turned(kBoomFoot.x(), kBoomFoot.y(), kBoomFoot.z(), angles.boom);
  const Isometry3d stick = boom * turned(kBoomLength, 0, 0, angles.stick);
  const Isometry3d bucket = stick * turned(kStickLength, 0, 0, angles.bucket);
  parts.push_back({&boom_, boom, label});
  parts.push_back({&stick_, stick, label});
  parts.push_back({&bucket_, bucket, label});
}

}  // namespace raymoval::simulated
