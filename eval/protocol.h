// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
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

namespace raymoval {

/// What a protocol scores against: posed scans, a label word per point, and what labels mean.
struct EvaluationInput {
  const ScanSource* scans = nullptr;
  const LabelSource* labels = nullptr;
  LabelRule label_rule;
  RangeLimits range_m;  ///< Points outside are on neither side of the comparison.
  /// Calibration of the camera whose poses the data set gives ("Tr"); none if they are the LiDAR's.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  int threads = 1;
  Progress* progress = nullptr;
};

/// A rate in percent or a fraction, as its name says; without a value where it is undefined.
struct Rate {
  std::string name;
  std::optional<double> value;
  std::string undefined_reason = "";
};

/// 100 part / whole as a rate; undefined for `reason` where `whole` is 0.
Rate percent_rate(const std::string& name, std::int64_t part, std::int64_t whole,
                  const std::string& reason);

/// Integer counts first, the rates that follow from them second.
struct ProtocolResult {
  std::string protocol;
  std::vector<std::pair<std::string, std::int64_t>> counts;
  std::vector<Rate> rates;
  std::vector<std::string> warnings;
  /// Of the protocol's main rates, by block bootstrap over scans; none if it does not draw any.
  std::optional<Intervals> intervals = std::nullopt;

  /// @throws InternalError if there is no such count.
  [[nodiscard]] std::int64_t count(const std::string& name) const;
  /// The rate called `name`; no value if it is undefined or not part of this protocol.
  [[nodiscard]] std::optional<double> rate(const std::string& name) const;
};

class CloudEstimate;

/// What depends on scans and labels only, built once for a sequence and shared by all methods.
class TruthMap {
 public:
  virtual ~TruthMap() = default;
};

/// (scans, labels, masks) -> counts -> rates. Same input, same counts, for any number of threads.
class Protocol {
 public:
  virtual ~Protocol() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string version() const = 0;  ///< Raised when counts may change.
  [[nodiscard]] virtual Configuration options() const = 0;
  /// Whether counts depend on `EvaluationInput::T_camera_lidar` too.
  [[nodiscard]] virtual bool reads_calibration() const { return false; }
  /// @throws DataError if there is nothing to score against (no point left after cropping).
  [[nodiscard]] virtual std::unique_ptr<TruthMap> prepare(const EvaluationInput& input) const = 0;
  /// @param truth what `prepare` of this protocol made from the same input
  /// @param masks one mask per scan, as long as the scan has points
  [[nodiscard]] virtual ProtocolResult score(const EvaluationInput& input, const TruthMap& truth,
                                             const MaskStore& masks) const = 0;
  /// Scores a cleaned map without labels that was made elsewhere; labels are found again by nearest
  /// neighbour. Not to be mixed with scores by masks in one table.
  /// @param cloud points in the world frame of the scans' poses
  /// @throws UsageError if the options rule it out
  [[nodiscard]] virtual ProtocolResult score_cloud(const EvaluationInput& input,
                                                   const TruthMap& truth,
                                                   const CloudEstimate& cloud) const = 0;
};

/// Names, options and makers of the protocols; `make_protocol("erasor", options)`.
struct ProtocolEntry {
  std::string name;
  std::string sentence;
  std::vector<ParameterSpec> parameters;
};
const std::vector<ProtocolEntry>& protocol_entries();
/// The protocol called `name`. @throws UsageError suggesting the nearest name.
const ProtocolEntry& protocol_entry(const std::string& name);
/// Options of `name` at their defaults. @throws UsageError suggesting the nearest name.
Configuration protocol_defaults(const std::string& name);
std::unique_ptr<Protocol> make_protocol(const std::string& name, const Configuration& options);

}  // namespace raymoval
