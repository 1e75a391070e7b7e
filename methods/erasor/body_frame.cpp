// SPDX-License-Identifier: MIT
#include "methods/erasor/body_frame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "methods/common/plane_fit.h"

namespace raymoval::erasor_method {
namespace {

/// Discs around the sensor in which the height of the ground is looked for, metres. The first is
/// what a sensor passes over, the others are for one that stands.
constexpr double kDiscs[] = {1.5, 3.0, 6.0, 12.0};
/// Voxels that tell the height of the ground: fewer may be noise.
constexpr std::size_t kEnough = 20;
/// Share of the voxels below the ground: echoes that stand nowhere.
constexpr double kBelowGround = 0.1;
/// Discs in which the slope of the ground is fitted, one after the other, metres.
constexpr double kSlopeDiscs[] = {3.0, 6.0, 12.0};
/// Ground is what lies lowest in a square of so many metres, and so near the plane before.
constexpr double kSquare = 1.0, kNearPlane = 0.3;
/// The least upright normal of a ground: 45 degrees.
const double kLeastUpright = std::sqrt(0.5);

/// Calls `take(from_sensor)` with each of the map's voxels within `radius` that lies lower than the
/// sensor.
template <class Take>
void for_voxels_below(const Eigen::Vector3d& sensor, double radius, const NaiveMap& map,
                      Take&& take) {
  for (const NaiveMap::Tile& tile : map.tiles_around(sensor.x(), sensor.y(), radius)) {
    for (VoxelNumber voxel = tile.begin; voxel < tile.end; ++voxel) {
      if (!map.is_in(voxel)) continue;
      const Eigen::Vector3d from_sensor = map.point(voxel) - sensor;
      const bool is_near = from_sensor.head<2>().squaredNorm() <= radius * radius;
      if (is_near && from_sensor.z() < 0.0) take(from_sensor);
    }
  }
}

/// Height of the ground, metres above the sensor, so that it is negative.
std::optional<double> ground_height(const Eigen::Vector3d& sensor, const NaiveMap& map) {
  for (const double radius : kDiscs) {
    std::vector<double> heights;
    for_voxels_below(sensor, radius, map,
                     [&](const Eigen::Vector3d& point) { heights.push_back(point.z()); });
    if (heights.size() < kEnough) continue;
    const auto place =
        static_cast<std::ptrdiff_t>(kBelowGround * static_cast<double>(heights.size() - 1));
    std::nth_element(heights.begin(), heights.begin() + place, heights.end());
    return heights[static_cast<std::size_t>(place)];
  }
  return std::nullopt;
}

/// What lies lowest in each square of a disc around the sensor.
std::vector<Eigen::Vector3d> lowest_points(const Eigen::Vector3d& sensor, double radius,
                                           const NaiveMap& map) {
  std::map<std::pair<int, int>, Eigen::Vector3d> lowest;
  for_voxels_below(sensor, radius, map, [&](const Eigen::Vector3d& point) {
    const std::pair square{static_cast<int>(std::floor(point.x() / kSquare)),
                           static_cast<int>(std::floor(point.y() / kSquare))};
    const auto [found, is_new] = lowest.emplace(square, point);
    if (!is_new && point.z() < found->second.z()) found->second = point;
  });
  std::vector<Eigen::Vector3d> points;
  for (const auto& [square, point] : lowest) points.push_back(point);
  return points;
}

/// The ground in a frame that is that of the world with the sensor at its origin.
std::optional<Plane> ground_around(const Eigen::Vector3d& sensor, const NaiveMap& map) {
  const auto height = ground_height(sensor, map);
  if (!height) return std::nullopt;
  Plane ground;
  ground.offset = -*height;
  for (const double radius : kSlopeDiscs) {
    const std::vector<Eigen::Vector3d> points = lowest_points(sensor, radius, map);
    Mask is_ground(points.size());
    std::transform(points.begin(), points.end(), is_ground.begin(), [&](const auto& point) {
      return std::abs(ground.height_of(point)) < kNearPlane ? 1 : 0;
    });
    const auto count = std::count(is_ground.begin(), is_ground.end(), 1);
    if (static_cast<std::size_t>(count) < kEnough) continue;
    const Plane fitted = fit_plane(points, is_ground).plane;
    if (fitted.normal.z() > kLeastUpright) ground = fitted;
  }
  return ground;
}

}  // namespace

Pose body_frame(const Pose& T_world_sensor, const NaiveMap& map, const Parameters& parameters) {
  Pose T_body_sensor = Pose::Identity();
  T_body_sensor.translation().z() = parameters.sensor_height;
  if (parameters.body == Body::kSensor) return T_body_sensor;
  Plane ground;
  ground.offset = parameters.sensor_height;
  ground = ground_around(T_world_sensor.translation(), map).value_or(ground);
  const Eigen::Vector3d up = ground.normal;
  Eigen::Vector3d ahead = T_world_sensor.linear().col(0);
  ahead -= up.dot(ahead) * up;
  if (ahead.norm() < 1e-6) ahead = up.unitOrthogonal();
  ahead.normalize();
  Eigen::Matrix3d R_world_body;
  R_world_body << ahead, up.cross(ahead), up;
  T_body_sensor.linear() = R_world_body.transpose() * T_world_sensor.linear();
  T_body_sensor.translation().z() = ground.offset;
  return T_body_sensor;
}

int minimum_points_of(const SensorModel& sensor, const Parameters& parameters) {
  if (!parameters.points_by_beams || sensor.elevation_step <= 0.0) return parameters.minimum_points;
  const double published = sensor_model_named("hdl64e").elevation_step;
  const double share = std::min(1.0, published / sensor.elevation_step);
  return std::max(1, static_cast<int>(std::lround(parameters.minimum_points * share)));
}

}  // namespace raymoval::erasor_method
