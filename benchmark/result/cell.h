// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters.h"
#include "datasets/sequence_record.h"
#include "eval/columns/columns.h"
#include "eval/confidence/reliability.h"
#include "eval/protocol.h"

namespace raymoval {

/// Version of the layout of cell.json, run.json and results.json.
inline constexpr int kSchemaVersion = 1;

/// How a cell ended.
enum class CellStatus { kOk, kFailed, kTimeout, kOutOfMemory, kBadData };

/// "ok", "failed", "timeout", "out_of_memory", "bad_data".
const char* status_name(CellStatus status);
/// The status with this name; no value if there is none.
std::optional<CellStatus> status_called(const std::string& name);

/// The method of a cell with all parameters as used.
struct MethodRecord {
  std::string name;     ///< Name of the method in the registry, "raymoval".
  std::string variant;  ///< "offline".
  std::string version;
  bool online = false;
  bool control = false;
  Configuration parameters = {};
};

/// A protocol of a suite.
struct ProtocolRecord {
  std::string name;      ///< Unique in the suite: "erasor", or the value of "as".
  std::string protocol;  ///< Name in the registry.
  std::string version;
  Configuration options = {};
};

/// The result of one protocol for one cell.
struct Score {
  ProtocolRecord protocol;
  std::vector<std::pair<std::string, std::int64_t>> counts = {};
  std::vector<Rate> rates = {};
  std::vector<std::string> warnings = {};
  std::optional<Intervals> intervals = std::nullopt;
  CountsByScan by_scan = {};

  /// As `rate_of`.
  [[nodiscard]] std::optional<double> rate(const std::string& name) const;
  /// The interval of a rate, which has both ends; null if there is none.
  [[nodiscard]] const Interval* interval(const std::string& rate) const;
};

/// The value of a rate; no value if it is undefined or not among `rates`.
std::optional<double> rate_of(const std::vector<Rate>& rates, const std::string& name);

/// Shares of points by class, range and height.
struct ColumnRecord {
  std::string version;
  std::vector<ColumnValue> values;

  /// 0 of 0 if there is no such column.
  [[nodiscard]] Share find(const std::string& name) const {
    for (const ColumnValue& column : values) {
      if (column.name == name) return column.share;
    }
    return {};
  }
};

/// The points that a method removed.
struct MaskRecord {
  std::string digest;        ///< Equal masks have equal digests.
  std::int64_t removed = 0;  ///< Points.
};

/// The time that a method spent in one of its stages, summed over threads.
struct StageSeconds {
  std::string name;
  double seconds = 0.0;
};

/// The cost of running a method. No other part of a cell differs from run to run.
struct Measurement {
  int threads = 1;
  double mean_seconds = 0.0;  ///< Per scan, without waiting for scans.
  std::optional<double> median_seconds = std::nullopt, p90_seconds = std::nullopt;
  double total_seconds = 0.0;  ///< Without waiting for scans.
  double load_seconds = 0.0;   ///< Waiting for scans.
  std::vector<StageSeconds> stages = {};
  std::optional<double> peak_memory_mib = std::nullopt;
  /// Number of cells that ran at once on the machine, which makes each slower. No value: the method
  /// ran alone.
  std::optional<int> side_by_side = std::nullopt;
};

/// The result of one sequence with one method and one set of parameters, scored by every protocol
/// of the suite. It is the content of cell.json (results/schema/cell.schema.json).
struct Cell {
  std::string sequence;
  std::string name;  ///< Name of the method in the suite, "raymoval:online".
  std::string key;   ///< See `cell_key`; empty if the data could not be read.
  CellStatus status = CellStatus::kOk;
  std::string reason = {};       ///< Why there is no result.
  std::string output_tail = {};  ///< The end of the output of a method in its own process.
  MethodRecord method = {};
  std::optional<DataRecord> data = std::nullopt;  ///< No value if the data could not be read.
  std::vector<Score> scores = {};  ///< One for each protocol; empty unless the status is kOk.
  std::optional<ColumnRecord> columns = std::nullopt;
  std::optional<Reliability> reliability = std::nullopt;  ///< Set if confidences were requested.
  std::optional<MaskRecord> masks = std::nullopt;
  std::optional<Measurement> measured = std::nullopt;  ///< No value in a reference without times.

  [[nodiscard]] bool ok() const { return status == CellStatus::kOk; }
  /// Sets a status without a result: scores and columns are dropped.
  void fail(CellStatus why, const std::string& text);
  /// "town / raymoval:online", for messages.
  [[nodiscard]] std::string title() const { return sequence + " / " + name; }
  /// The score by the protocol that the suite calls `protocol`; null if there is none.
  [[nodiscard]] const Score* score(const std::string& protocol) const;
};

/// All inputs that determine the counts of a cell.
struct CellIdentity {
  MethodRecord method;
  DataRecord data;
  std::vector<ProtocolRecord> protocols;
};

}  // namespace raymoval
