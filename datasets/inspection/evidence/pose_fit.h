// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// Says why the scans do not agree under the given poses, if they do not.
///
/// For some pairs of near scans, three agreements are compared: that under the given poses, that
/// under each hypothesis, and the best that registration of the two scans reaches from any start.
/// The given poses are good if they come near to the best. Else the hypothesis that does names the
/// defect; if none does, poses and scans do not belong together. Where registration itself finds
/// little in common (empty fields, a blocked sensor), nothing is said.
const PoseVerdict& pose_verdict(Samples& samples);

/// Whether it makes sense to measure how well poses fit: there are two scans or more, in metres,
/// and `pose_verdict` is empty.
bool can_measure_fit(Samples& samples);
/// How well poses fit; without pairs where that cannot be measured.
const registration::PoseFit& measured_fit(Samples& samples);

/// Median of every tenth point of a scan, coordinate by coordinate.
Eigen::Vector3d middle_of(const Scan& scan);

}  // namespace raymoval::inspection
