// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// What one protocol said of a method then.
struct RecordedScore {
  std::string protocol, version;
  std::vector<std::pair<std::string, std::int64_t>> counts = {};
  std::vector<std::pair<std::string, std::optional<double>>> rates = {};
};

/// What a method took, as multiples of the time of a fixed kernel that ran beside it.
struct RecordedSpeed {
  std::string yardstick;
  int rounds = 0;
  double milliseconds = 0.0;                     ///< The median of the method.
  double median = 0.0, least = 0.0, most = 0.0;  ///< In yardsticks.
};

/// A line of a history: what a method scored on a scene, as a commit was built, on a machine
/// (results/schema/history.schema.json). `scripts/record.sh` appends it.
struct HistoryLine {
  std::string commit;   ///< In full.
  std::string date;     ///< Of the commit, in UTC: "2026-11-23T08:26:54Z".
  std::string version;  ///< Of the program.
  std::string machine;  ///< A name that tells machines apart.
  std::string sequence, fingerprint;
  std::string method;  ///< With its variant, "raymoval:offline".
  std::string method_version;
  std::string status;  ///< As of a cell; without a result there are no scores.
  std::string masks;   ///< Digest.
  std::vector<RecordedScore> scores = {};
  std::optional<RecordedSpeed> speed = std::nullopt;
};

/// The lines of all files *.jsonl of `folder`, or of one file, sorted by date; lines of one date
/// stay in the order of the files.
/// @throws DataError if there is no such file, or a line is none of a history: it names the line
std::vector<HistoryLine> read_history(const std::filesystem::path& folder);

/// What is another at a line than at the one before of the same method, scene and machine.
struct HistoryEvent {
  HistoryLine line;
  /// In words: "counts", "method version 2 to 3", "1.42 times slower". Empty: nothing changed.
  std::vector<std::string> changes = {};
  bool is_first = false;
  /// By how much each rate moved, where it was recorded before: "F1", 0.0123.
  std::vector<std::pair<std::string, double>> moved = {};
};

/// A method on a scene on a machine, over time.
struct HistoryTrack {
  std::string sequence, method, machine;
  std::vector<HistoryEvent> events = {};
};

/// Sorts lines into tracks, by sequence and method in the order in which they first appear.
/// @param band by which factor a time may change before it counts
std::vector<HistoryTrack> history_tracks(const std::vector<HistoryLine>& lines, double band);

}  // namespace raymoval
