// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters.h"
#include "core/progress.h"
#include "core/scan/label_rule.h"
#include "core/scan/mask_store.h"
#include "core/scan/range_limits.h"
#include "core/scan/scan_source.h"
#include "eval/bootstrap.h"
#include "eval/rate.h"

namespace raymoval {

class CloudEstimate;
struct CheckedScan;

/// The truth of a protocol: posed scans, a label word for each point, and the meaning of labels.
struct EvaluationInput {
  const ScanSource* scans = nullptr;
  const LabelSource* labels = nullptr;
  LabelRule label_rule;
  RangeLimits range_m;  ///< Points outside are on neither side of the comparison.
  /// Calibration of the camera whose poses the data set gives ("Tr"); nothing if the poses are
  /// those of the LiDAR.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;  ///< Set when scoring is to stop; null: it never is.
};

/// @param asker is named in the message
/// @throws DataError if `input` has no labels
void check_input(const EvaluationInput& input, const std::string& asker);

/// Counts by name, with a value for each scan.
using CountsByScan = std::vector<std::pair<std::string, std::vector<std::int64_t>>>;

/// The score of an answer by a protocol. The rates follow from the counts.
struct ProtocolResult {
  std::string protocol;
  std::vector<std::pair<std::string, std::int64_t>> counts;
  std::vector<Rate> rates;
  std::vector<std::string> warnings;
  /// Of the protocol's main rates, by block bootstrap over scans; nothing if the protocol does not
  /// draw any.
  std::optional<Intervals> intervals = std::nullopt;
  /// Counts of each scan, in order; nothing if a protocol does not count scan by scan.
  CountsByScan by_scan = {};

  /// @throws InternalError if there is no such count.
  [[nodiscard]] std::int64_t count(const std::string& name) const;
  /// The value of a rate; nothing if it is undefined or not part of this protocol.
  [[nodiscard]] std::optional<double> rate(const std::string& name) const;
};

/// Reads all scans of an answer, in passes: a pass gives it each scan once. All visitors of the
/// same answer share its passes, so that a scan is read once for all of them (`run_passes`).
class ScanVisitor {
 public:
  virtual ~ScanVisitor() = default;
  /// True if the next pass needs much memory and should run last. Visitors without this have their
  /// passes first. Then each of the others has all of its passes in turn.
  [[nodiscard]] virtual bool runs_last() const { return false; }
  /// Prepares the next pass.
  /// @param slots how many scans may be in work at a time
  /// @return false if no further pass is needed
  virtual bool begin_pass(std::size_t slots) = 0;
  /// Reads a scan and stores the input of `take` in `slot`. Several threads call it at a time,
  /// each with a slot of its own, also while another thread is in `take`.
  virtual void read(const CheckedScan& scan, std::size_t slot) = 0;
  /// Adds the result of `read` in `slot`. It is called once per scan, in the order of the scans.
  virtual void take(std::size_t slot) = 0;
};

/// The scoring of one answer by one protocol.
class Scoring : public ScanVisitor {
 public:
  /// The score. Called once, after the last pass.
  [[nodiscard]] virtual ProtocolResult result() = 0;
};

/// A protocol opened for one sequence. It holds the data that depends on scans and labels only, so
/// one scorer serves all methods. Several threads may score answers with it at a time.
class Scorer {
 public:
  explicit Scorer(EvaluationInput input) : input_(std::move(input)) {}
  virtual ~Scorer() = default;
  Scorer(const Scorer&) = delete;
  Scorer& operator=(const Scorer&) = delete;

  /// Begins to score an answer. The scorer outlives the scoring.
  [[nodiscard]] virtual std::unique_ptr<Scoring> start() const = 0;
  /// Scores an answer by this protocol alone.
  /// @param masks one mask per scan, as long as the scan has points
  /// @throws MethodError if a mask is missing or has the wrong length
  [[nodiscard]] ProtocolResult score(const MaskStore& masks) const;
  /// Scores a cleaned map without labels that was made elsewhere. Labels are found again by nearest
  /// neighbour, so the result must not be in one table with scores of masks. A protocol that does
  /// not override this function scores no clouds.
  /// @param cloud points in the world frame of the scans' poses
  /// @throws UsageError if the protocol or its options rule it out
  [[nodiscard]] virtual ProtocolResult score_cloud(const CloudEstimate& cloud) const;

 protected:
  [[nodiscard]] const EvaluationInput& input() const { return input_; }

 private:
  EvaluationInput input_;
};

/// The description of a protocol.
struct ProtocolEntry {
  std::string name;
  std::string version;  ///< Raised when counts may change.
  std::string sentence;
  std::string bibtex = {};  ///< Of the paper that it comes from.
  std::vector<ParameterSpec> parameters;
  std::vector<RateSpec> rates;    ///< All rates that its results may have, in the order of tables.
  std::vector<CountSpec> counts;  ///< All counts that its results may have.
  /// Opens the protocol for a sequence. The input's scans, labels and progress outlive the scorer.
  /// @throws DataError if there is nothing to score against (no point is left after cropping)
  std::function<std::unique_ptr<Scorer>(const EvaluationInput&, const Configuration& options)> open;
  /// Options with which a cleaned cloud is scored, where they differ from the defaults.
  Configuration cloud_options = {};
  /// Whether counts depend on `EvaluationInput::T_camera_lidar` with these options. Null: they
  /// never do.
  std::function<bool(const Configuration& options)> reads_calibration = nullptr;
  /// Whether these options let a point pass for another, so that the rates of an answer that
  /// removes exactly the moving points depend on the data. Null: no options do.
  std::function<bool(const Configuration& options)> oracle_is_uncertain = nullptr;
};

/// A protocol with its options: (scans, labels, masks) -> counts -> rates. The same input gives the
/// same counts, for any number of threads.
class Protocol {
 public:
  /// @param entry must outlive this object
  /// @param options options that are not given have their defaults
  /// @throws ConfigurationError for an unknown option
  Protocol(const ProtocolEntry& entry, const Configuration& options);

  [[nodiscard]] const std::string& name() const { return entry_.name; }
  [[nodiscard]] const std::string& version() const { return entry_.version; }
  [[nodiscard]] const Configuration& options() const { return options_; }
  [[nodiscard]] bool reads_calibration() const;
  /// Checks, without reading a scan, that the sequence has what the protocol needs.
  /// @throws DataError if it has no labels, or no calibration although counts depend on it
  void check(const EvaluationInput& input) const;
  /// @param input its scans, labels and progress must outlive the scorer
  /// @throws DataError as `check`, or if there is nothing to score against
  [[nodiscard]] std::unique_ptr<Scorer> open(const EvaluationInput& input) const;

 private:
  const ProtocolEntry& entry_;
  Configuration options_;
};

/// Options of a protocol at their defaults.
Configuration default_options(const ProtocolEntry& entry);

}  // namespace raymoval
