// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/suite/suite.h"
#include "core/progress.h"
#include "core/scan/confidence_store.h"
#include "core/scan/local_frame.h"
#include "datasets/sequence.h"
#include "eval/columns/columns.h"
#include "eval/confidence/reliability.h"
#include "eval/points/cloud_masks.h"
#include "eval/protocol_registry.h"

namespace raymoval {

/// The scores of an answer on a sequence.
struct SequenceScores {
  std::vector<ProtocolResult> protocols;  ///< In the order of the sequence's protocols.
  std::vector<ColumnValue> columns;       ///< By class, range and height.
  std::optional<Reliability> reliability = std::nullopt;  ///< Set if there are confidences.
};

/// A warning if methods would remove static points because the poses do not fit; else empty.
std::string pose_fit_line(const std::optional<PoseFitRecord>& fit);

/// An opened sequence with the protocols that score on it. Data that a protocol derives from scans
/// and labels is built at the first use, then shared by all methods. Once the fingerprint is known,
/// cells may be scored on several threads at once.
class ScoredSequence {
 public:
  /// @throws DataError if the sequence has no labels, ConfigurationError for bad options
  ScoredSequence(Sequence sequence, const std::vector<ProtocolRequest>& requests, int threads,
                 Progress* progress);

  [[nodiscard]] const Sequence& sequence() const { return sequence_; }
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] Progress* progress() const { return progress_; }
  [[nodiscard]] std::size_t protocol_count() const { return protocols_.size(); }
  [[nodiscard]] const std::string& protocol_name(std::size_t i) const { return protocols_[i].name; }
  [[nodiscard]] const Protocol& protocol(std::size_t i) const { return *protocols_[i].protocol; }

  /// Hash of all data that methods and protocols read; computed once. @throws DataError
  const std::string& data_fingerprint();

  /// How well the poses fit the scans; no value if no two scans overlap enough.
  /// @throws DataError if a scan cannot be read; Cancelled
  [[nodiscard]] std::optional<PoseFitRecord> measure_pose_fit(
      const std::atomic<bool>* cancel) const;

  /// The masks of an answer that removes exactly the moving points, read together with the
  /// fingerprint. Their sizes are those of the scans. @throws DataError as `data_fingerprint`
  [[nodiscard]] const MaskStore& moving_points();

  /// Builds the data that protocols derive from scans and labels, if not done yet. Afterwards
  /// several threads may score at once.
  /// @throws DataError if there is nothing to score against
  void open_protocols();

  /// Scores `masks` by all protocols and by columns. All of them read a scan together.
  /// @param cancel ends the scoring when it is set; may be null
  /// @param confidence of the method that gave the masks; may be empty
  /// @throws DataError, MethodError as the protocols; Cancelled
  SequenceScores score(const MaskStore& masks, const std::atomic<bool>* cancel = nullptr,
                       const ConfidenceStore& confidence = {});

  /// Scores a cleaned cloud by protocol `i`.
  ProtocolResult score_cloud(std::size_t i, const CloudEstimate& cloud);

  /// Which points of the scans are not found again in a cleaned cloud (see `masks_of_cloud`).
  [[nodiscard]] const MaskStore& cloud_masks(const CloudEstimate& cloud) const;

  /// Shares of removed points by class, range and height.
  [[nodiscard]] std::vector<ColumnValue> columns(const MaskStore& masks) const;

 private:
  struct OpenedProtocol {
    std::string name;
    std::unique_ptr<Protocol> protocol;
    std::unique_ptr<Scorer> scorer;  ///< Null until it is first needed.
    /// Held while the scorer is made, for cells that run at once.
    std::unique_ptr<std::mutex> making = std::make_unique<std::mutex>();
  };
  [[nodiscard]] EvaluationInput input() const;

  Sequence sequence_;
  /// The scans as protocols get them: from `lattice_origin`.
  std::unique_ptr<const LocalFrameSource> scored_scans_;
  int threads_;
  Progress* progress_;
  std::string fingerprint_;
  MaskStore moving_points_;
  std::vector<OpenedProtocol> protocols_;
};

}  // namespace raymoval
