// SPDX-License-Identifier: MIT
#include "benchmark/run/sequence_bench.h"

#include <algorithm>
#include <utility>

#include "benchmark/process/method_run.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

void check_has_calibration(const Protocol& protocol, const Sequence& sequence) {
  if (!protocol.reads_calibration() || sequence.T_camera_lidar) return;
  throw DataError("protocol " + protocol.name() + " as asked for (frame = erasor) needs the " +
                  "calibration of a camera (calib.txt, row Tr) and its poses; sequence '" +
                  sequence.name +
                  "' has those of the LiDAR. Leave the option at frame = sequence.");
}

}  // namespace

SequenceBench::SequenceBench(Sequence sequence, const std::vector<ProtocolRequest>& requests,
                             int threads, Progress* progress)
    : watched_(watched(std::move(sequence))), threads_(threads), progress_(progress) {
  const Sequence& opened = watched_.sequence;
  check_has_labels(opened);
  if (opened.scans->size() == 0) {
    throw DataError("sequence '" + opened.name + "' has no scan in the chosen frames (" +
                    opened.frames + "). Choose others with --frames.");
  }
  scored_scans_ = std::make_unique<LocalFrameSource>(*opened.scans, lattice_frame(*opened.scans));
  for (const ProtocolRequest& request : requests) {
    scorers_.push_back({request.name, make_protocol(request.protocol, request.options), nullptr});
    check_has_calibration(*scorers_.back().protocol, opened);
  }
}

const std::string& SequenceBench::data_fingerprint() {
  if (!fingerprint_.empty()) return fingerprint_;
  fingerprint_ = fingerprint(sequence(), threads_);
  loaded_ = watched_.loaded();
  const bool calibrated = std::any_of(scorers_.begin(), scorers_.end(), [](const Scorer& scorer) {
    return scorer.protocol->reads_calibration();
  });
  if (calibrated && sequence().T_camera_lidar) {
    const Eigen::Matrix4d calibration = sequence().T_camera_lidar->matrix();
    ContentHasher hasher;
    hasher.add(fingerprint_);
    hasher.add(calibration.data(), sizeof(double) * 16);
    fingerprint_ = hasher.digest();
  }
  return fingerprint_;
}

std::string SequenceBench::data_change(const LoadedData* loaded) {
  (void)data_fingerprint();
  LoadedData expected = loaded_;
  expected.change = watched_.record->data().change;
  return changed_data(expected, loaded != nullptr ? *loaded : loaded_);
}

EvaluationInput SequenceBench::input() const {
  EvaluationInput input;
  input.scans = scored_scans_.get();
  input.labels = sequence().labels.get();
  input.label_rule = sequence().label_rule;
  input.range_m = sequence().range_m;
  input.T_camera_lidar = sequence().T_camera_lidar;
  input.threads = threads_;
  input.progress = progress_;
  return input;
}

std::vector<ColumnValue> SequenceBench::columns(const MaskStore& masks) const {
  return column_values(tally_removals(input(), masks));
}

const SequenceBench::Scorer& SequenceBench::prepared(std::size_t i) {
  Scorer& scorer = scorers_[i];
  if (scorer.truth == nullptr) scorer.truth = scorer.protocol->prepare(input());
  return scorer;
}

ProtocolResult SequenceBench::score(std::size_t i, const MaskStore& masks) {
  const Scorer& scorer = prepared(i);
  return scorer.protocol->score(input(), *scorer.truth, masks);
}

ProtocolResult SequenceBench::score_cloud(std::size_t i, const CloudEstimate& cloud) {
  const Scorer& scorer = prepared(i);
  return scorer.protocol->score_cloud(input(), *scorer.truth, cloud);
}

const MaskStore& SequenceBench::cloud_masks(const CloudEstimate& cloud) const {
  return cloud.masks(input(), kCloudDistance);
}

}  // namespace raymoval
