// SPDX-License-Identifier: MIT
#include "datasets/reading/loaded_data.h"

#include <utility>

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/reading/fingerprint.h"

namespace raymoval {
namespace {

class WatchedScans : public ScanSource {
 public:
  WatchedScans(std::shared_ptr<const ScanSource> scans, std::shared_ptr<LoadRecord> record)
      : scans_(std::move(scans)), record_(std::move(record)) {}
  [[nodiscard]] std::size_t size() const override { return scans_->size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = scans_->load(index);
    record_->note(scan);
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override { return scans_->pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return scans_->sensor(); }

 private:
  std::shared_ptr<const ScanSource> scans_;
  std::shared_ptr<LoadRecord> record_;
};

class WatchedLabels : public LabelSource {
 public:
  WatchedLabels(std::shared_ptr<const LabelSource> labels, std::shared_ptr<LoadRecord> record)
      : labels_(std::move(labels)), record_(std::move(record)) {}
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    std::vector<std::uint32_t> words = labels_->labels(scan);
    record_->note(scan, words);
    return words;
  }

 private:
  std::shared_ptr<const LabelSource> labels_;
  std::shared_ptr<LoadRecord> record_;
};

constexpr const char* kRemedy =
    "Scores would be of a mixture. Run again when nothing writes to the data any more.";

std::string changed(const std::string& scan, const char* what) {
  return "the data changed while it was used: " + std::string(what) + " of scan " + scan +
         " are not what they were before. " + kRemedy;
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

void LoadRecord::note(const Scan& scan) {
  ContentHasher hasher;
  add_scan(hasher, scan);
  note(data_.scans, scan, hasher.digest(), kScanParts);
}

void LoadRecord::note(const Scan& scan, const std::vector<std::uint32_t>& labels) {
  ContentHasher hasher;
  add_labels(hasher, labels);
  note(data_.labels, scan, hasher.digest(), kLabelParts);
}

void LoadRecord::note(std::vector<std::string>& known, const Scan& scan, const std::string& hash,
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
  inner.scans = std::make_shared<WatchedScans>(inner.scans, result.record);
  if (inner.labels) inner.labels = std::make_shared<WatchedLabels>(inner.labels, result.record);
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
             "the data changed while it was used: poses, sensor, ranges or label rule are "
             "not what they were before. ") +
         kRemedy;
}

}  // namespace raymoval
