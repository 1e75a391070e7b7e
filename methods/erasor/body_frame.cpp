// SPDX-License-Identifier: MIT
#include "methods/erasor/body_frame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/sampling.h"
#include "methods/common/plane_fit.h"

namespace raymoval::erasor_method {
namespace {

/// Radii of discs around the sensor for the search of the ground's height, metres. The first is for
/// a moving sensor, the others for a stationary one.
constexpr double kDiscs[] = {1.5, 3.0, 6.0, 12.0};
/// Sides of the columns whose feet give the height of the ground, and its slope, metres.
constexpr double kHeightColumn = 0.5, kSlopeColumn = 1.0;
/// Least number of feet for the height of the ground: fewer may be noise.
constexpr std::size_t kEnoughFeet = 10;
/// Points separated by a larger vertical gap are on different storeys, metres: more than the step
/// between two beams on a near car, and less than the height of any storey.
constexpr double kStoreyGap = 0.6;
/// The ground has at least this share of the feet of the storey with the most feet. Higher groups
/// with fewer feet are roofs of cars and similar.
constexpr double kGroundShare = 0.5;
/// Radii of the discs in which the slope of the ground is fitted in turn, metres.
constexpr double kSlopeDiscs[] = {3.0, 6.0, 12.0};
/// Least number of feet for fitting a slope.
constexpr std::size_t kEnoughForSlope = 20;
/// Largest distance of ground feet from the previous plane, metres.
constexpr double kNearPlane = 0.3;
/// The least vertical component of a ground normal: 45 degrees.
const double kLeastUpright = std::sqrt(0.5);

/// Calls `take(from_sensor)` for each voxel of the map within `radius` that is lower than the
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

/// The feet on the storey of the sensor: of the groups that are `kStoreyGap` apart, the highest one
/// with enough feet. No value if no group has `kEnoughFeet`.
/// @param heights relative to the sensor, all negative
std::optional<std::vector<double>> storey_of_sensor(std::vector<double> heights) {
  std::sort(heights.begin(), heights.end());
  std::vector<std::vector<double>> storeys;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (i == 0 || heights[i] - heights[i - 1] > kStoreyGap) storeys.emplace_back();
    storeys.back().push_back(heights[i]);
  }
  std::size_t most = 0;
  for (const auto& storey : storeys) most = std::max(most, storey.size());
  const double enough =
      std::max(static_cast<double>(kEnoughFeet), kGroundShare * static_cast<double>(most));
  for (auto storey = storeys.rbegin(); storey != storeys.rend(); ++storey) {
    if (static_cast<double>(storey->size()) >= enough) return std::move(*storey);
  }
  return std::nullopt;
}

/// The feet of the columns of a disc around the sensor, relative to it: points without another
/// point within `kStoreyGap` below. A column through a bridge has a foot on the road and one on the
/// deck.
std::vector<Eigen::Vector3d> column_feet(const Eigen::Vector3d& sensor, double radius, double side,
                                         const NaiveMap& map) {
  std::map<std::pair<int, int>, std::vector<Eigen::Vector3d>> columns;
  for_voxels_below(sensor, radius, map, [&](const Eigen::Vector3d& point) {
    columns[{static_cast<int>(std::floor(point.x() / side)),
             static_cast<int>(std::floor(point.y() / side))}]
        .push_back(point);
  });
  std::vector<Eigen::Vector3d> feet;
  for (auto& [square, points] : columns) {
    std::sort(points.begin(), points.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return std::tuple(a.z(), a.x(), a.y()) < std::tuple(b.z(), b.x(), b.y());
    });
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == 0 || points[i].z() - points[i - 1].z() > kStoreyGap) feet.push_back(points[i]);
    }
  }
  return feet;
}

/// Height of the ground on the storey of the sensor, metres relative to the sensor (negative).
std::optional<double> ground_height(const Eigen::Vector3d& sensor, const NaiveMap& map) {
  for (const double radius : kDiscs) {
    std::vector<double> heights;
    for (const Eigen::Vector3d& foot : column_feet(sensor, radius, kHeightColumn, map)) {
      heights.push_back(foot.z());
    }
    if (const auto storey = storey_of_sensor(std::move(heights))) return median(*storey);
  }
  return std::nullopt;
}

/// The ground in the frame with the world's axes and its origin at the sensor.
std::optional<Plane> ground_around(const Eigen::Vector3d& sensor, const NaiveMap& map) {
  const auto height = ground_height(sensor, map);
  if (!height) return std::nullopt;
  Plane ground;
  ground.offset = -*height;
  for (const double radius : kSlopeDiscs) {
    const std::vector<Eigen::Vector3d> points = column_feet(sensor, radius, kSlopeColumn, map);
    Mask is_ground(points.size());
    std::transform(points.begin(), points.end(), is_ground.begin(), [&](const auto& point) {
      return std::abs(ground.height_of(point)) < kNearPlane ? 1 : 0;
    });
    const auto count = std::count(is_ground.begin(), is_ground.end(), 1);
    if (static_cast<std::size_t>(count) < kEnoughForSlope) continue;
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

bool is_ego_vehicle(const Eigen::Vector3f& point, const Pose& T_world_sensor,
                    const Parameters& parameters) {
  Eigen::Vector3d from_sensor = point.cast<double>();
  if (parameters.body == Body::kGround) from_sensor = T_world_sensor.linear() * from_sensor;
  return from_sensor.head<2>().squaredNorm() < parameters.minimum_range * parameters.minimum_range;
}

int minimum_points_of(const SensorModel& sensor, const Parameters& parameters) {
  if (!parameters.points_by_beams || sensor.elevation_step <= 0.0) return parameters.minimum_points;
  const double published = sensor_model_named("hdl64e").elevation_step;
  const double share = std::min(1.0, published / sensor.elevation_step);
  return std::max(1, static_cast<int>(std::lround(parameters.minimum_points * share)));
}

}  // namespace raymoval::erasor_method
