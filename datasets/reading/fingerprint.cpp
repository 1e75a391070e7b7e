// SPDX-License-Identifier: MIT
#include "datasets/reading/fingerprint.h"

#include "core/error.h"
#include "core/files/files.h"
#include "core/parallel.h"

namespace raymoval {
namespace {

/// Adds plain numbers as bytes.
template <class Number>
void add_number(ContentHasher& hasher, Number value) {
  hasher.add(&value, sizeof value);
}

template <class Value>
void add_vector(ContentHasher& hasher, const std::vector<Value>& values) {
  add_number(hasher, std::uint64_t{values.size()});
  hasher.add(values.data(), values.size() * sizeof(Value));
}

/// Adds sensor model, range limits, label rule, and spin axis and up if they are not z.
void add_settings(ContentHasher& hasher, const Sequence& sequence) {
  const SensorModel& sensor = sequence.scans->sensor();
  for (const double value :
       {sensor.azimuth_min, sensor.azimuth_max, sensor.elevation_min, sensor.elevation_max,
        sensor.azimuth_step, sensor.elevation_step, sensor.range_min, sensor.range_max,
        sensor.missing_return_is_meaningful ? 1.0 : 0.0, sequence.range_m.min, sequence.range_m.max,
        sequence.labels ? 1.0 : 0.0}) {
    add_number(hasher, value);
  }
  if (sensor.spin_axis != Eigen::Vector3d::UnitZ()) {
    hasher.add(sensor.spin_axis.data(), sizeof(double) * 3);
  }
  add_vector(hasher, sequence.label_rule.moving);
  add_vector(hasher, sequence.label_rule.ignored);
  const UpDirection up = sequence.up();
  if (!up.is_world_z()) hasher.add(up.direction.data(), sizeof(double) * 3);
}

/// Hash of time, pose, points, reflectance and labels, but not of the name.
std::string scan_hash(const Sequence& sequence, std::size_t index) {
  const Scan scan = sequence.scans->load(index);
  ContentHasher hasher;
  add_number(hasher, scan.time_s);
  const Eigen::Matrix4d pose = scan.T_world_sensor.matrix();
  hasher.add(pose.data(), sizeof(double) * 16);
  add_vector(hasher, scan.points);
  add_vector(hasher, scan.reflectance);
  if (sequence.labels) add_vector(hasher, sequence.labels->labels(scan));
  return hasher.digest();
}

}  // namespace

std::string fingerprint(const Sequence& sequence, int threads) {
  const std::size_t count = sequence.scans->size();
  std::vector<std::string> digests(count);
  parallel_for(threads, count, 1, [&](std::size_t i) { digests[i] = scan_hash(sequence, i); });
  ContentHasher hasher;
  add_settings(hasher, sequence);
  for (const std::string& digest : digests) hasher.add(digest);
  return hasher.digest();
}

}  // namespace raymoval
