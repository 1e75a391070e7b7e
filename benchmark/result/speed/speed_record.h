// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"

namespace raymoval {

/// A time in milliseconds, and as a multiple of the time of the yardstick, a fixed kernel that is
/// timed beside it in the same program. Multiples of different machines can be compared.
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
  SpeedFigure score;   ///< All protocols. Data that methods share is made before.
};

/// The content of speed.json, written by `scripts/benchmark.sh`: whole cells of every method on one
/// scene.
struct SpeedRecord {
  std::string scene = {};  ///< As for --sequence.
  int scans = 0;
  int threads = 1;
  int repetitions = 0;
  std::string yardstick = {};  ///< Its name, which changes with its work.
  double yardstick_milliseconds = 0.0;
  std::string processor = {}, commit = {};  ///< For a reader.
  std::vector<CellSpeed> cells = {};
};

/// @throws DataError if the file is missing or of another kind; FieldError; SchemaVersionError
SpeedRecord read_speed(const std::filesystem::path& file);
/// @throws DataError
void write_speed(const std::filesystem::path& file, const SpeedRecord& speed);

/// The comparison of two files of times of whole cells.
struct SpeedComparison {
  std::vector<std::string> incomparable;  ///< Why they cannot be compared.
  std::vector<std::string> worse;         ///< Figures beyond the band.
  std::vector<std::string> lines;         ///< A line for each method.

  /// kCannotDo if anything is not comparable, else kWorse if anything is worse, else kDone.
  [[nodiscard]] ExitCode verdict() const;
};

/// The default factor by which a cell or a part may become slower.
inline constexpr double kSpeedBand = 1.3;
/// A part that takes less than this share of its cell is too short to be judged by itself.
inline constexpr double kJudgedShare = 0.1;

/// Compares the medians, in yardsticks, of each cell and of each part of it. Methods that only the
/// run has do not affect the verdict.
/// @param band the allowed factor of growth
SpeedComparison compare_speed(const SpeedRecord& run, const SpeedRecord& reference, double band);

/// The comparison as lines for a reader.
std::string speed_text(const SpeedComparison& comparison);

}  // namespace raymoval
