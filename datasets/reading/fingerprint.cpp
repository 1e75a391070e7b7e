// SPDX-License-Identifier: MIT
#include "datasets/reading/fingerprint.h"

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

std::string scan_hash(const Sequence& sequence, std::size_t index) {
  const Scan scan = sequence.scans->load(index);
  ContentHasher hasher;
  add_scan(hasher, scan);
  if (sequence.labels) add_labels(hasher, sequence.labels->labels(scan));
  return hasher.digest();
}

}  // namespace

void add_scan(ContentHasher& hasher, const Scan& scan) {
  add_number(hasher, scan.time_s);
  const Eigen::Matrix4d pose = scan.T_world_sensor.matrix();
  hasher.add(pose.data(), sizeof(double) * 16);
  add_vector(hasher, scan.points);
  add_vector(hasher, scan.reflectance);
}

void add_labels(ContentHasher& hasher, const std::vector<std::uint32_t>& labels) {
  add_vector(hasher, labels);
}

void add_settings(ContentHasher& hasher, const Sequence& sequence) {
  const SensorModel& sensor = sequence.scans->sensor();
  for (const double value :
       {sensor.azimuth_min, sensor.azimuth_max, sensor.elevation_min, sensor.elevation_max,
        sensor.azimuth_step, sensor.elevation_step, sensor.range_min, sensor.range_max,
        sensor.missing_return_is_meaningful ? 1.0 : 0.0, sequence.range_m.min, sequence.range_m.max,
        sequence.labels ? 1.0 : 0.0}) {
    add_number(hasher, value);
  }
  add_vector(hasher, sequence.label_rule.moving);
  add_vector(hasher, sequence.label_rule.ignored);
  const UpDirection up = sequence.up();
  if (!up.is_world_z()) hasher.add(up.direction.data(), sizeof(double) * 3);
}

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
