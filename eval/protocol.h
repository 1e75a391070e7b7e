// SPDX-License-Identifier: MIT
#pragma once

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

/// What a protocol scores against: posed scans, a label word for each point, and what labels mean.
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
};

/// @param asker stands in the message
/// @throws DataError if `input` has no labels
void check_input(const EvaluationInput& input, const std::string& asker);

/// What a protocol says of an answer. The rates follow from the counts.
struct ProtocolResult {
  std::string protocol;
  std::vector<std::pair<std::string, std::int64_t>> counts;
  std::vector<Rate> rates;
  std::vector<std::string> warnings;
  /// Of the protocol's main rates, by block bootstrap over scans; nothing if the protocol does not
  /// draw any.
  std::optional<Intervals> intervals = std::nullopt;

  /// @throws InternalError if there is no such count.
  [[nodiscard]] std::int64_t count(const std::string& name) const;
  /// The value of a rate; nothing if it is undefined or not part of this protocol.
  [[nodiscard]] std::optional<double> rate(const std::string& name) const;
};

/// A protocol opened for one sequence. It holds what depends on scans and labels only, so one
/// scorer serves all methods.
class Scorer {
 public:
  virtual ~Scorer() = default;
  /// @param masks one mask per scan, as long as the scan has points
  /// @throws MethodError if a mask is missing or has the wrong length
  [[nodiscard]] virtual ProtocolResult score(const MaskStore& masks) const = 0;
  /// Scores a cleaned map without labels that was made elsewhere. Labels are found again by nearest
  /// neighbour, so the result must not stand in one table with scores by masks. A protocol that
  /// does not override this function scores no clouds.
  /// @param cloud points in the world frame of the scans' poses
  /// @throws UsageError if the protocol or its options rule it out
  [[nodiscard]] virtual ProtocolResult score_cloud(const CloudEstimate& cloud) const;
};

/// (scans, labels, masks) -> counts -> rates. The same input gives the same counts, for any number
/// of threads.
class Protocol {
 public:
  virtual ~Protocol() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string version() const = 0;  ///< Raised when counts may change.
  [[nodiscard]] virtual Configuration options() const = 0;
  /// Whether counts depend on `EvaluationInput::T_camera_lidar` too.
  [[nodiscard]] virtual bool reads_calibration() const { return false; }
  /// Checks, without reading a scan, that the sequence has what the protocol needs.
  /// @throws DataError if it has no labels, or lacks what the options ask for
  virtual void check(const EvaluationInput& input) const { check_input(input, name()); }
  /// @param input its scans, labels and progress must outlive the scorer
  /// @throws DataError as `check`, or if there is nothing to score against (no point is left after
  /// cropping)
  [[nodiscard]] virtual std::unique_ptr<Scorer> open(const EvaluationInput& input) const = 0;
};

/// What is known of a protocol before it is made. `eval/protocol_registry.h` holds all entries.
struct ProtocolEntry {
  std::string name;
  std::string sentence;
  std::vector<ParameterSpec> parameters;
  std::vector<RateSpec> rates;    ///< All that its results may have, in the order of tables.
  std::vector<CountSpec> counts;  ///< All that its results may have.
  std::function<std::unique_ptr<Protocol>(const Configuration& options)> make;
  /// Options with which a cleaned cloud is scored, where they differ from the defaults.
  Configuration cloud_options = {};
  /// Whether these options let a point pass for another, so that the rates of an answer that
  /// removes exactly the moving points depend on the data. Null: no options do.
  std::function<bool(const Configuration& options)> oracle_is_uncertain = nullptr;
};

}  // namespace raymoval
