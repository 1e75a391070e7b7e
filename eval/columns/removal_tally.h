// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/scan/mask_store.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol.h"

namespace raymoval {

/// Points, and how many of them a method removed.
struct PointTally {
  std::int64_t points = 0;
  std::int64_t removed = 0;

  PointTally& operator+=(const PointTally& other);
  [[nodiscard]] std::int64_t kept() const { return points - removed; }
};

/// Instance id of a label word; 0: the point belongs to no instance.
constexpr std::uint16_t instance_id(std::uint32_t word) {
  return static_cast<std::uint16_t>(word >> 16U);
}

inline constexpr std::size_t kRangeBands = 6;
inline constexpr std::size_t kHeightBands = 5;
/// Bands of time are tenths of a sequence's scans.
inline constexpr std::size_t kTimeBands = 10;

/// Lower edges of the bands, in metres of 3-D distance from the sensor.
inline constexpr std::array<double, kRangeBands> kRangeEdges = {0, 10, 20, 30, 40, 50};
/// Lower edges in metres of height, which is z in the sensor frame plus `kHeightOffset`.
inline constexpr std::array<double, kHeightBands> kHeightEdges = {
    -std::numeric_limits<double>::infinity(), 0.3, 1, 2, 4};
/// The ERASOR protocol's lift, the height of its sensor above the road.
inline constexpr double kHeightOffset = 1.73;
/// The ERASOR protocol's crop: points nearer to the sensor's z axis are not counted.
inline constexpr double kMinimumHorizontalRange = 2.7;

/// "0-10 m", "50 m and more", "below 0.3 m", "0-10 %".
std::string range_band_name(std::size_t band);
std::string height_band_name(std::size_t band);
std::string time_band_name(std::size_t band);

/// A semantic class of the truth. Its points are counted three times: by range, height and time.
struct ClassTally {
  bool moving = false;
  std::array<PointTally, kRangeBands> by_range;
  std::array<PointTally, kHeightBands> by_height;
  std::array<PointTally, kTimeBands> by_time;

  [[nodiscard]] PointTally all() const;
};

/// Points of each semantic id that occurs, in the order of ids, and of each object.
struct RemovalTally {
  LabelRule label_rule;  ///< Says what the ids mean.
  std::map<std::uint16_t, ClassTally> classes;
  /// By label word: semantic id and instance id, where the instance id is not 0.
  std::map<std::uint32_t, PointTally> objects;
};

/// Counts the points that the `erasor` protocol evaluates by default (in range, not ignored, not
/// cropped), by index, in one pass.
class RemovalCount : public ScanVisitor {
 public:
  /// @param input must outlive this object. @throws DataError if it has no labels
  explicit RemovalCount(const EvaluationInput& input);

  bool begin_pass(std::size_t slots) override;
  void read(const CheckedScan& scan, std::size_t slot) override;
  void take(std::size_t slot) override;
  [[nodiscard]] const RemovalTally& tally() const { return all_; }

 private:
  const EvaluationInput& input_;
  LabelClasses classes_;
  std::vector<RemovalTally> slots_;
  RemovalTally all_;
};

/// The counts of one answer. @throws MethodError, DataError as `run_passes`
RemovalTally tally_removals(const EvaluationInput& input, const MaskStore& masks);

}  // namespace raymoval
