// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/speed/speed_record.h"
#include "core/error.h"

namespace raymoval {

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
