// SPDX-License-Identifier: MIT
#include "datasets/clouds/returns.h"

#include <utility>

#include "core/error.h"
#include "core/scan/local_frame.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Share of infinite coordinates above which a scan is damaged (evaluation protocol, edge cases).
/// NaN is no damage: drivers write it for a missing return.
constexpr double kMostInfinite = 0.01;
/// In the world frame, stored points nearer to the origin than this are missing returns, metres.
/// The sensor is hardly ever so near to that origin.
constexpr float kAtZero = 1e-3F;

/// The kind of a stored point.
enum class PointKind { kReturn, kNoReturn, kInfinite };

PointKind kind_of(const Eigen::Vector3f& stored, float nearest) {
  if (stored.hasNaN()) return PointKind::kNoReturn;
  if (!stored.allFinite()) return PointKind::kInfinite;
  return stored.squaredNorm() < nearest * nearest ? PointKind::kNoReturn : PointKind::kReturn;
}

void check_kinds(const ReturnCounts& counts, const std::string& where, const std::string& remedy) {
  if (counts.stored == 0) return;
  const double infinite = static_cast<double>(counts.infinite) / static_cast<double>(counts.stored);
  if (infinite > kMostInfinite) {
    throw DataError(where + ": " + grouped_text(counts.infinite) + " of " +
                    grouped_text(counts.stored) +
                    " points are infinite, more than 1 %; the file looks damaged. Write missing "
                    "returns as NaN." +
                    remedy);
  }
}

/// Fills points, reflectance and stored_index with the returns among the points of `cloud`.
/// @param nearest a stored point nearer to the origin is no return, metres
ReturnCounts keep_returns(Cloud&& cloud, float nearest, Scan& scan) {
  ReturnCounts counts;
  counts.stored = scan.stored_point_count = cloud.points.size();
  for (const Eigen::Vector3f& point : cloud.points) {
    const PointKind kind = kind_of(point, nearest);
    counts.no_returns += kind == PointKind::kNoReturn ? 1 : 0;
    counts.infinite += kind == PointKind::kInfinite ? 1 : 0;
  }
  if (counts.returns() == counts.stored) {
    scan.points = std::move(cloud.points);
    scan.reflectance = std::move(cloud.intensity);
    return counts;
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (kind_of(cloud.points[i], nearest) != PointKind::kReturn) continue;
    scan.points.push_back(cloud.points[i]);
    if (!cloud.intensity.empty()) scan.reflectance.push_back(cloud.intensity[i]);
    scan.stored_index.push_back(static_cast<std::uint32_t>(i));
  }
  return counts;
}

/// Transforms the returns among `points` from the world to the sensor; other points are unchanged.
/// @param origin the origin that was subtracted from the points when they were read
void bring_to_sensor(const Pose& T_sensor_world, const Eigen::Vector3d& origin,
                     std::vector<Eigen::Vector3f>& points) {
  const Eigen::Vector3f zero = (-origin).cast<float>();  // The stored origin.
  for (Eigen::Vector3f& point : points) {
    const Eigen::Vector3f stored = point - zero;
    const bool is_return = kind_of(stored, kAtZero) == PointKind::kReturn;
    point = is_return ? (T_sensor_world * point.cast<double>()).cast<float>() : stored;
  }
}

}  // namespace

void keep_points(Scan& scan, std::vector<std::uint32_t> kept) {
  if (kept.size() == scan.size()) return;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    scan.points[k] = scan.points[kept[k]];
    if (!scan.reflectance.empty()) scan.reflectance[k] = scan.reflectance[kept[k]];
  }
  scan.points.resize(kept.size());
  if (!scan.reflectance.empty()) scan.reflectance.resize(kept.size());
  for (std::uint32_t& position : kept) {
    position = static_cast<std::uint32_t>(scan.stored_position(position));
  }
  scan.stored_index = std::move(kept);
}

ReturnCounts read_returns(Scan& scan, PointFrame frame, const std::string& where,
                          const std::function<Cloud(const Eigen::Vector3d&)>& read,
                          const std::string& remedy) {
  const bool in_world = frame == PointFrame::kWorld;
  // The sensor's position is subtracted before rounding to float32, which keeps digits of points
  // far from the world's origin.
  Pose T_world_sensor = scan.T_world_sensor;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (in_world && T_world_sensor.translation().cwiseAbs().maxCoeff() > kFarFromOrigin) {
    origin = T_world_sensor.translation();
    T_world_sensor.translation().setZero();
  }
  Cloud cloud = read(origin);
  if (in_world) bring_to_sensor(T_world_sensor.inverse(), origin, cloud.points);
  const ReturnCounts counts = keep_returns(std::move(cloud), kAtSensor, scan);
  check_kinds(counts, where, remedy);
  return counts;
}

void drop_bad_scans(std::vector<std::optional<Pose>>& poses,
                    const std::function<std::string(std::size_t)>& name,
                    const std::function<void(std::size_t)>& read, const std::atomic<bool>* cancel,
                    std::vector<std::string>& losses) {
  constexpr std::size_t kNamed = 8;
  std::vector<std::string> names;
  std::string first;
  std::size_t bad = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    throw_if_cancelled(cancel);
    if (!poses[i]) continue;
    try {
      read(i);
    } catch (const DataError& error) {
      poses[i].reset();
      if (++bad == 1) first = error.what();
      if (bad <= kNamed) names.push_back(name(i));
    }
  }
  if (bad == 0) return;
  const std::string remedy = kRereadRemedy;
  const std::size_t at = first.find(remedy);
  if (at != std::string::npos) first.erase(at, remedy.size());
  if (bad > kNamed) names.push_back(grouped_text(bad - kNamed) + " more");
  const std::string what = grouped_text(bad) + " of " + counted_text(poses.size(), "scan") +
                           " cannot be read (" + join(names) + ")";
  if (2 * bad >= poses.size()) {
    throw DataError(what + "; expected fewer than half. The first: " + first +
                    " Check the layout of the points, or copy the scans again.");
  }
  losses.push_back(what + " and are left out, as asked by --skip-bad-scans. The first: " +
                   first.substr(first.rfind('/', first.find(": ")) + 1));
}

}  // namespace raymoval
