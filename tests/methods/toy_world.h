// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/angle.h"
#include "core/scan/mask_store.h"
#include "methods/remover.h"
#include "tests/methods/held_scans.h"

namespace raymoval::toy {

/// The unit vector at an azimuth and an elevation, radians.
inline Eigen::Vector3d direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Axis-aligned solid in world coordinates, metres.
struct Box {
  Eigen::Vector3d low, high;
};

/// Distance at which a ray enters `box`; infinite if it misses it.
inline double enter_distance(const Box& box, const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) {
  double near = 0.0, far = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (origin[k] < box.low[k] || origin[k] > box.high[k]) return far;
      continue;
    }
    const double a = (box.low[k] - origin[k]) / direction[k];
    const double b = (box.high[k] - origin[k]) / direction[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far ? near : std::numeric_limits<double>::infinity();
}

/// Half-degree scanner, 41 rows from -10 to +10 degrees.
struct Scanner {
  double azimuth_from = -180.0;  ///< Degrees.
  double azimuth_to = 180.0;
  double range = 50.0;
  double elevation_step = 0.5;  ///< In the model, degrees; rows are always half a degree apart.

  [[nodiscard]] SensorModel model() const {
    SensorModel sensor;
    sensor.azimuth_min = azimuth_from * kDegree;
    sensor.azimuth_max = azimuth_to * kDegree;
    sensor.elevation_min = -10.0 * kDegree;
    sensor.elevation_max = 10.0 * kDegree;
    sensor.azimuth_step = 0.5 * kDegree;
    sensor.elevation_step = elevation_step * kDegree;
    sensor.range_max = range;
    sensor.missing_return_is_meaningful = true;
    return sensor;
  }
};

/// Scans of boxes; `owner[scan][point]` is the number of the box that was hit.
class World : public HeldScans {
 public:
  explicit World(const Scanner& scanner) : HeldScans(scanner.model()), scanner_(scanner) {}

  /// Scans `boxes` from `T_world_sensor` and appends the scan.
  void scan(const std::vector<Box>& boxes, const Pose& T_world_sensor) {
    std::vector<Eigen::Vector3f> points;
    std::vector<int> hit;
    for (double azimuth = scanner_.azimuth_from + 0.25; azimuth < scanner_.azimuth_to;
         azimuth += 0.5) {
      for (int row = -20; row <= 20; ++row) {
        const double elevation = row * 0.5 * kDegree;
        add_return(boxes, T_world_sensor, azimuth * kDegree, elevation, points, hit);
      }
    }
    add(std::move(points), T_world_sensor);
    owner.push_back(hit);
  }

  std::vector<std::vector<int>> owner;

 private:
  void add_return(const std::vector<Box>& boxes, const Pose& T_world_sensor, double azimuth,
                  double elevation, std::vector<Eigen::Vector3f>& points,
                  std::vector<int>& hit) const {
    const Eigen::Vector3d u = direction(azimuth, elevation);
    double nearest = scanner_.range;
    int box_hit = -1;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const double distance =
          enter_distance(boxes[b], T_world_sensor.translation(), T_world_sensor.linear() * u);
      if (distance < nearest) {
        nearest = distance;
        box_hit = static_cast<int>(b);
      }
    }
    if (box_hit < 0) return;
    points.emplace_back((nearest * u).cast<float>());
    hit.push_back(box_hit);
  }

  Scanner scanner_;
};

/// Keeps the masks of a run.
class Masks : public RemovalSink {
 public:
  explicit Masks(std::size_t scans) : store(scans) {}
  void accept(std::size_t scan, const Mask& mask) override { store.set(scan, mask); }
  MaskStore store;
};

/// Runs a method over a world.
inline MaskStore masks_of(Remover& remover, const ScanSource& scans, int threads = 1) {
  Masks masks(scans.size());
  RunContext context;
  context.threads = threads;
  remover.run(scans, masks, context);
  return masks.store;
}

/// Share of the points on box `owner` that are removed, over scans [first, last].
inline double removed_share(const World& world, const MaskStore& masks, int owner,
                            std::size_t first, std::size_t last) {
  int points = 0, removed = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const Mask mask = masks.get(i);
    for (std::size_t k = 0; k < mask.size(); ++k) {
      if (world.owner[i][k] != owner) continue;
      ++points;
      removed += mask[k];
    }
  }
  return points == 0 ? -1.0 : static_cast<double>(removed) / points;
}

}  // namespace raymoval::toy
