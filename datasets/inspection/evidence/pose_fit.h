// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// Finds the defect if the scans do not agree under the given poses.
///
/// For some pairs of near scans, three agreements are compared: under the given poses, under each
/// hypothesis, and the best agreement of registration from any start. The given poses are good if
/// their agreement is close to the best. Else a hypothesis with a close agreement names the defect;
/// without one, poses and scans do not belong together. If registration finds little in common
/// (empty fields, a blocked sensor), the verdict is empty.
const PoseVerdict& pose_verdict(Samples& samples);

/// Whether the fit of poses can be measured: there are two scans or more, in metres, and
/// `pose_verdict` is empty.
bool can_measure_fit(Samples& samples);
/// The fit of the poses; without pairs if it cannot be measured.
const registration::PoseFit& measured_fit(Samples& samples);

/// Whether all files have one VIEWPOINT, although their points move from scan to scan.
bool has_one_viewpoint(const Samples& samples);

/// Median of every tenth point of a scan, coordinate by coordinate.
Eigen::Vector3d middle_of(const Scan& scan);

}  // namespace raymoval::inspection
