// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "benchmark/run/scored_sequence.h"
#include "benchmark/submission/submission.h"

namespace raymoval {

/// Whether what a submitted cell says is what its masks score.
enum class SubmissionVerdict { kHolds, kDiffers, kUnchecked };

/// What verifying a cell found.
struct Verification {
  SubmittedCell submitted;
  std::vector<std::string> differences;  ///< What the cell says otherwise than its masks.
  std::string problem = {};              ///< Why it could not be checked to the end; else empty.
  SequenceScores scores = {};            ///< Of the masks; empty unless they were scored.

  /// A difference that was found counts also where the rest could not be checked.
  [[nodiscard]] SubmissionVerdict verdict() const;
};

/// Protocols that score as the cell says it was scored.
/// @throws DataError if a protocol is not known here, or is of another version
std::vector<ProtocolRequest> requested_protocols_of(const Cell& cell);

/// How the data of a cell was read, as far as the cell says: frames, range and own vehicle. What
/// is set in `given` stands above it. @throws UsageError if the cell names no such range or region
SequenceOptions reading_of(const Cell& cell, SequenceOptions given);

/// Whether two cells were made from the same data.
bool same_data(const Cell& a, const Cell& b);

/// Whether two protocols score alike, whatever a suite calls them, so that what they say of the
/// same data can stand in one table.
bool same_scoring(const ProtocolRecord& a, const ProtocolRecord& b);

/// Whether two cells were made from the same data by the same protocols in the same order, so that
/// one `ScoredSequence` scores both.
bool same_sequence(const Cell& a, const Cell& b);

/// Compares the cell with what its masks score:
/// - its key with its method, parameters, data and protocols, from which it follows;
/// - its data's fingerprint with that of the sequence;
/// - the digest and the number of removed points with those of the masks;
/// - counts, rates, intervals with how they were drawn, and shares of points with those of the
///   masks: nothing may be missing, and nothing may be there that the masks do not score.
/// A cell whose shares of points are of another `kColumnsVersion` cannot be checked.
/// It cannot see whether the masks are those of the method: only running the method tells.
/// @param scored the sequence with `requested_protocols_of(cell)`
/// @throws Cancelled
Verification verify_cell(const SubmittedCell& submitted, ScoredSequence& scored,
                         const std::atomic<bool>* cancel);

/// "holds", "does not hold" or "cannot be checked", with a line for each reason.
std::string verification_text(const Verification& verification);

}  // namespace raymoval
