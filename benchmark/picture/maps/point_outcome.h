// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/picture/canvas/colours.h"
#include "core/scan/mask_store.h"
#include "datasets/sequence.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// What became of a point.
enum class Outcome : std::uint8_t {
  kKeptStatic,
  kTruePositive,   ///< Moving and removed.
  kFalsePositive,  ///< Static and removed.
  kFalseNegative,  ///< Moving and kept.
};
inline constexpr std::size_t kOutcomes = 4;

Colour outcome_colour(Outcome outcome);
/// The name in legends, such as "moving, removed".
const char* outcome_name(Outcome outcome);
/// The outcomes in the order of legends.
inline constexpr std::array<Outcome, kOutcomes> kLegendOrder = {
    Outcome::kTruePositive, Outcome::kFalsePositive, Outcome::kFalseNegative, Outcome::kKeptStatic};

constexpr Outcome outcome_of(bool moving, bool removed) {
  if (moving) return removed ? Outcome::kTruePositive : Outcome::kFalseNegative;
  return removed ? Outcome::kFalsePositive : Outcome::kKeptStatic;
}

/// A point that is shown, and what became of it.
struct PointOutcome {
  Eigen::Vector3d world;  ///< In the frame of the scans, metres.
  double above_sensor;    ///< Height above the sensor, metres.
  Outcome outcome;
};
/// Receives a point once for each of the masks, with the number of the mask.
using VisitPoint = std::function<void(std::size_t mask, const PointOutcome& point)>;

/// Visits, scan by scan, the points of a sequence that protocols evaluate by default. They are in
/// range, their label is not ignored, and they are not on the ego vehicle (within 2.7 m of the
/// sensor's axis).
/// @param scans of the sequence, in a frame whose z axis points up
/// @param masks what each method removed
/// @param task what the progress says
/// @throws Cancelled
void for_each_shown_point(const Sequence& sequence, const ScanSource& scans,
                          const std::vector<MaskStore>& masks, const std::string& task,
                          const OpenContext& context, const VisitPoint& visit);

}  // namespace raymoval
