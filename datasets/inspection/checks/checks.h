// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/inspection/evidence/finding.h"
#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// A check for one kind of defect.
struct Check {
  std::string name;
  std::string finds;     ///< The defect, as a sentence without its full stop.
  std::string expected;  ///< The property of good data.
  std::string remedy;    ///< General remedy; a finding may have names and numbers.
  /// Returns findings with at least `what`. Default for `where` are the pose source and frames, for
  /// `expected` and `remedy` the texts above.
  std::function<std::vector<Finding>(Samples&)> look;
  Consequence consequence = Consequence::kWarned;
};

/// The check for scans without a pose, also if too many lack one to open the sequence.
inline constexpr const char* kMissingPoses = "scans-without-poses";

/// The parts of the table of checks. Checks of poses share one `pose_verdict`.
std::vector<Check> pose_checks();
std::vector<Check> point_checks();
std::vector<Check> label_checks();
std::vector<Check> time_checks();
std::vector<Check> ego_checks();
std::vector<Check> sensor_model_checks();
std::vector<Check> skew_checks();
std::vector<Check> world_checks();
std::vector<Check> reach_checks();
std::vector<Check> recording_checks();
std::vector<Check> origin_checks();
std::vector<Check> fit_checks();

/// The check of this name. @throws InternalError if there is none
const Check& check_named(const std::string& name);

/// "hdl64e; the scans show 64 beams, 0.173 deg by 0.427 deg, ..."; "estimated: 64 beams, ...".
std::string sensor_text(const Samples& samples);

/// "poses fit to 0.02 m (median of 45 pairs of scans; ...)". @param samples with a `pose_fit`
std::string pose_fit_text(const Samples& samples);

}  // namespace raymoval::inspection
