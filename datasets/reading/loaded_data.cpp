// SPDX-License-Identifier: MIT
#include "datasets/reading/loaded_data.h"

#include <utility>

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

/// Adds time, pose, points and reflectance, but not the name.
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

std::string scan_hash(const Sequence& sequence, std::size_t index) {
  const Scan scan = sequence.scans->load(index);
  ContentHasher hasher;
  add_scan(hasher, scan);
  if (sequence.labels) add_labels(hasher, sequence.labels->labels(scan));
  return hasher.digest();
}

class WatchedSources : public ScanSource, public LabelSource {
 public:
  WatchedSources(const Sequence& sequence, std::shared_ptr<LoadRecord> record)
      : scans_(sequence.scans), labels_(sequence.labels), record_(std::move(record)) {}
  [[nodiscard]] std::size_t size() const override { return scans_->size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = scans_->load(index);
    record_->add(scan);
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override { return scans_->pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return scans_->sensor(); }
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    std::vector<std::uint32_t> words = labels_->labels(scan);
    record_->add(scan, words);
    return words;
  }

 private:
  std::shared_ptr<const ScanSource> scans_;
  std::shared_ptr<const LabelSource> labels_;
  std::shared_ptr<LoadRecord> record_;
};

constexpr const char* kRemedy =
    "Scores would be of a mixture. Run again when nothing writes to the data any more.";

std::string changed(const std::string& scan, const char* what) {
  return "the data changed while it was used: " + std::string(what) + " of scan " + scan +
         " differ from before. " + kRemedy;
}

bool differs(const std::string& expected, const std::string& found) {
  return !found.empty() && found != expected;
}

constexpr const char* kScanParts = "points, pose or time";
constexpr const char* kLabelParts = "the labels";

}  // namespace

LoadRecord::LoadRecord(std::size_t scans) {
  data_.names.resize(scans);
  data_.scans.resize(scans);
  data_.labels.resize(scans);
}

void LoadRecord::add(const Scan& scan) {
  ContentHasher hasher;
  add_scan(hasher, scan);
  add(data_.scans, scan, hasher.digest(), kScanParts);
}

void LoadRecord::add(const Scan& scan, const std::vector<std::uint32_t>& labels) {
  ContentHasher hasher;
  add_labels(hasher, labels);
  add(data_.labels, scan, hasher.digest(), kLabelParts);
}

void LoadRecord::add(std::vector<std::string>& known, const Scan& scan, const std::string& hash,
                     const char* what) {
  const std::lock_guard lock(mutex_);
  std::string& before = known.at(scan.index);
  if (before.empty()) before = hash;
  if (data_.names[scan.index].empty()) data_.names[scan.index] = scan.name;
  if (before == hash) return;
  const std::string change = changed(scan.name, what);
  if (data_.change.empty()) data_.change = change;
  throw DataError(change);
}

LoadedData LoadRecord::data() const {
  const std::lock_guard lock(mutex_);
  return data_;
}

LoadedData WatchedSequence::loaded() const {
  ContentHasher hasher;
  add_settings(hasher, sequence);
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    const Eigen::Matrix4d pose = sequence.scans->pose(i).matrix();
    hasher.add(pose.data(), sizeof(double) * 16);
  }
  LoadedData data = record->data();
  data.settings = hasher.digest();
  return data;
}

WatchedSequence watched(Sequence sequence) {
  WatchedSequence result{std::move(sequence), nullptr};
  Sequence& inner = result.sequence;
  result.record = std::make_shared<LoadRecord>(inner.scans->size());
  const auto sources = std::make_shared<const WatchedSources>(inner, result.record);
  inner.scans = sources;
  if (inner.labels) inner.labels = sources;
  return result;
}

std::string changed_data(const LoadedData& expected, const LoadedData& found) {
  if (!expected.change.empty()) return expected.change;
  if (!found.change.empty()) return found.change;
  if (found.scans.size() != expected.scans.size() ||
      found.labels.size() != expected.labels.size()) {
    return "the data changed while it was used: it had " + std::to_string(expected.scans.size()) +
           " scans and has " + std::to_string(found.scans.size()) + ". " + kRemedy;
  }
  for (std::size_t i = 0; i < expected.scans.size(); ++i) {
    const bool scan = differs(expected.scans[i], found.scans[i]);
    if (!scan && !differs(expected.labels[i], found.labels[i])) continue;
    return changed(expected.names[i], scan ? kScanParts : kLabelParts);
  }
  if (found.settings == expected.settings) return "";
  return std::string(
             "the data changed while it was used: poses, sensor, ranges or label rule differ from "
             "before. ") +
         kRemedy;
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
