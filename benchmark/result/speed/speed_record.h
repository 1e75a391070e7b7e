// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"

namespace raymoval {

/// What something takes: milliseconds, and the same as a multiple of the time of a fixed kernel,
/// the yardstick, which is timed beside it in the same program. Multiples of different machines can
/// be compared.
struct SpeedFigure {
  double milliseconds = 0.0;                     ///< The median.
  double median = 0.0, least = 0.0, most = 0.0;  ///< In yardsticks, over the repetitions.
};

/// The speed of one method's cell.
struct CellSpeed {
  std::string method;  ///< With its variant, "raymoval:offline".
  SpeedFigure whole;   ///< The sum of the parts.
  SpeedFigure load;    ///< Waiting for scans.
  SpeedFigure run;     ///< The method without waiting for scans.
  SpeedFigure score;   ///< All protocols, with what is not of one method made before.
};

/// What `scripts/benchmark.sh` writes to speed.json: whole cells of every method on one scene.
struct SpeedRecord {
  std::string scene = {};  ///< As for --sequence.
  int scans = 0;
  int threads = 1;
  int repetitions = 0;
  std::string yardstick = {};  ///< Its name, which changes whenever its work does.
  double yardstick_milliseconds = 0.0;
  std::string processor = {}, commit = {};  ///< For a reader.
  std::vector<CellSpeed> cells = {};
};

/// @throws DataError if the file is missing or no such file; FieldError; SchemaVersionError
SpeedRecord read_speed(const std::filesystem::path& file);
/// @throws DataError
void write_speed(const std::filesystem::path& file, const SpeedRecord& speed);

/// What two files of whole cells' times say of each other.
struct SpeedComparison {
  std::vector<std::string> incomparable;  ///< Why they cannot be compared.
  std::vector<std::string> worse;         ///< What is beyond the band.
  std::vector<std::string> lines;         ///< A line for each method.

  /// kCannotDo if anything is not comparable, else kWorse if anything is worse, else kDone.
  [[nodiscard]] ExitCode verdict() const;
};

/// How much slower a cell, or a part of it, may become by default.
inline constexpr double kSpeedBand = 1.3;
/// A part that takes less than this share of its cell is too short to be judged by itself.
inline constexpr double kJudgedShare = 0.1;

/// Compares the medians, in yardsticks, of each cell and of each part of it. Methods that only the
/// run has decide nothing.
/// @param band by which factor they may grow
SpeedComparison compare_speed(const SpeedRecord& run, const SpeedRecord& reference, double band);

/// The comparison as lines for a reader.
std::string speed_text(const SpeedComparison& comparison);

}  // namespace raymoval
