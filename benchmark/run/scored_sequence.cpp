// SPDX-License-Identifier: MIT
#include "benchmark/run/scored_sequence.h"

#include <algorithm>
#include <utility>

#include "benchmark/process/method_run.h"
#include "benchmark/process/split_sensors.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/reading/fingerprint.h"
#include "datasets/registration/pose_fit.h"
#include "eval/points/labelled_voxels.h"
#include "eval/scan_passes.h"

namespace raymoval {
namespace {

/// The protocol must list all rates and counts of its result, so that they have a description.
void check_is_listed(const ProtocolResult& result, const ProtocolEntry& entry) {
  const auto check = [&](const std::string& name, const auto& specs) {
    for (const auto& spec : specs) {
      if (spec.name == name) return;
    }
    throw InternalError("protocol " + entry.name + " gave '" + name + "', which it does not list");
  };
  for (const auto& [name, count] : result.counts) check(name, entry.counts);
  for (const Rate& rate : result.rates) check(rate.name, entry.rates);
}

void check_has_what_is_needed(const Protocol& protocol, const EvaluationInput& input,
                              const std::string& sequence) {
  try {
    protocol.check(input);
  } catch (const DataError& error) {
    throw DataError("sequence '" + sequence + "': " + error.what());
  }
}

/// Notes which points move when their labels are read.
class NotedLabels : public LabelSource {
 public:
  NotedLabels(std::shared_ptr<const LabelSource> source, const LabelRule& rule, MaskStore& moving)
      : source_(std::move(source)), classes_(rule), moving_(moving) {}
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    std::vector<std::uint32_t> words = source_->labels(scan);
    Mask mask(words.size());
    std::transform(words.begin(), words.end(), mask.begin(),
                   [&](std::uint32_t word) { return std::uint8_t{classes_.moving(word)}; });
    moving_.set(scan.index, mask);
    return words;
  }

 private:
  std::shared_ptr<const LabelSource> source_;
  LabelClasses classes_;
  MaskStore& moving_;
};

ProtocolResult checked(ProtocolResult result, const Protocol& protocol) {
  check_is_listed(result, protocol_entry(protocol.name()));
  return result;
}

/// The spin axis; +z if a scan cannot be read, which is reported when all data is read.
Eigen::Vector3d axis_of_readable(const Sequence& sequence) {
  try {
    return spin_axis_of(sequence);
  } catch (const DataError&) {
    return Eigen::Vector3d::UnitZ();
  }
}

}  // namespace

std::string pose_fit_line(const std::optional<PoseFitRecord>& fit) {
  if (!fit || registration::is_within_limits(fit->median_m, fit->worst_m)) return "";
  return "poses fit to " + fixed_text(fit->median_m, 3) + " m (worst pair of scans " +
         fixed_text(fit->worst_m, 3) +
         " m); where poses do not fit, methods remove static points. " +
         "`raymoval inspect` shows details.";
}

ScoredSequence::ScoredSequence(Sequence sequence, const std::vector<ProtocolRequest>& requests,
                               int threads, Progress* progress)
    : sequence_(std::move(sequence)), threads_(threads), progress_(progress) {
  const Sequence& opened = sequence_;
  check_has_labels(opened);
  if (opened.scans->size() == 0) {
    throw DataError("sequence '" + opened.name + "' has no scan in the chosen frames (" +
                    opened.frames + "). Choose others with --frames.");
  }
  scored_scans_ = std::make_unique<LocalFrameSource>(*opened.scans, lattice_frame(*opened.scans),
                                                     axis_of_readable(opened));
  for (const ProtocolRequest& request : requests) {
    protocols_.push_back({request.name, make_protocol(request.protocol, request.options), nullptr});
    check_has_what_is_needed(*protocols_.back().protocol, input(), opened.name);
  }
}

const std::string& ScoredSequence::data_fingerprint() {
  if (!fingerprint_.empty()) return fingerprint_;
  Sequence read = sequence();
  moving_points_ = MaskStore(read.scans->size());
  read.labels = std::make_shared<NotedLabels>(read.labels, read.label_rule, moving_points_);
  fingerprint_ = fingerprint(read, threads_);
  const bool calibrated =
      std::any_of(protocols_.begin(), protocols_.end(),
                  [](const OpenedProtocol& one) { return one.protocol->reads_calibration(); });
  if (calibrated && sequence().T_camera_lidar) {
    const Eigen::Matrix4d calibration = sequence().T_camera_lidar->matrix();
    ContentHasher hasher;
    hasher.add(fingerprint_);
    hasher.add(calibration.data(), sizeof(double) * 16);
    fingerprint_ = hasher.digest();
  }
  return fingerprint_;
}

std::optional<PoseFitRecord> ScoredSequence::measure_pose_fit(
    const std::atomic<bool>* cancel) const {
  const auto fit = registration::measure_pose_fit(sequence().as_opened(), threads_, cancel);
  if (fit.pairs.empty()) return std::nullopt;
  return PoseFitRecord{fit.distance_m, registration::worst_pair(fit).distance_m, fit.pairs.size()};
}

const MaskStore& ScoredSequence::moving_points() {
  (void)data_fingerprint();
  return moving_points_;
}

EvaluationInput ScoredSequence::input() const {
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

std::vector<ColumnValue> ScoredSequence::columns(const MaskStore& masks) const {
  return column_values(tally_removals(input(), masks));
}

void ScoredSequence::open_protocols() {
  const auto open = [&](OpenedProtocol& opened) {
    if (opened.scorer == nullptr) opened.scorer = opened.protocol->open(input());
  };
  // If several threads open the protocols, each thread first opens protocols that no other thread
  // opens.
  for (OpenedProtocol& opened : protocols_) {
    const std::unique_lock lock(*opened.making, std::try_to_lock);
    if (lock.owns_lock()) open(opened);
  }
  for (OpenedProtocol& opened : protocols_) {
    const std::lock_guard lock(*opened.making);
    open(opened);
  }
}

SequenceScores ScoredSequence::score(const MaskStore& masks, const std::atomic<bool>* cancel,
                                     const ConfidenceStore& confidence) {
  open_protocols();
  EvaluationInput scored = input();
  scored.cancel = cancel;
  RemovalCount removals(scored);
  std::vector<ScanVisitor*> visitors = {&removals};
  std::optional<ReliabilityCount> reliability;
  if (!confidence.empty()) visitors.push_back(&reliability.emplace(scored, confidence));
  std::vector<std::unique_ptr<Scoring>> scorings;
  for (const OpenedProtocol& opened : protocols_) {
    scorings.push_back(opened.scorer->start());
    visitors.push_back(scorings.back().get());
  }
  run_passes(scored, masks, visitors);
  SequenceScores scores;
  for (std::size_t i = 0; i < protocols_.size(); ++i) {
    scores.protocols.push_back(checked(scorings[i]->result(), protocol(i)));
    scorings[i].reset();
  }
  scores.columns = column_values(removals.tally());
  if (reliability) scores.reliability = reliability->reliability();
  return scores;
}

ProtocolResult ScoredSequence::score_cloud(std::size_t i, const CloudEstimate& cloud) {
  open_protocols();
  return checked(protocols_[i].scorer->score_cloud(cloud), protocol(i));
}

const MaskStore& ScoredSequence::cloud_masks(const CloudEstimate& cloud) const {
  return cloud.masks(input(), kCloudDistance);
}

}  // namespace raymoval
