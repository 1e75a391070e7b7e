// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/clouds/cloud_file.h"

namespace raymoval {

/// Counts what becomes of intensities where a file shows them as whole numbers from 0 to 65,535.
class IntensityCount {
 public:
  /// @param scale see `RecordWriting::intensity_scale`
  IntensityCount(ShownIntensity shown, double scale) : shown_(std::move(shown)), scale_(scale) {}

  /// @param rows of the layout that `shown` is a field of
  void add(const PointRecords& rows);
  /// What a user should know of it, in whole sentences: that most intensities are rounded to 0 or
  /// 1, or that some are too large. @param option of the map, such as "-o"
  [[nodiscard]] std::vector<std::string> remarks(const std::string& option) const;

 private:
  ShownIntensity shown_;
  double scale_;
  std::uint64_t faint_ = 0;      ///< More than 0 and less than 1.
  std::uint64_t too_large_ = 0;  ///< More than 65,535.
  std::uint64_t positive_ = 0;
};

}  // namespace raymoval
