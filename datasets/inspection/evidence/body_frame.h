// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/inspection/evidence/pair_fit.h"

namespace raymoval::inspection {

/// Whether the sensor turns by about the angles that its poses turn by, about whatever axis. This
/// does not depend on how the sensor is turned on the body that has the poses.
bool turns_as_much(const Samples& samples, const std::vector<SeenMotion>& seen);

/// R_body_sensor under which the poses of a body move as the scans do, whatever the position of the
/// sensor on the body: first the best turn about z, then the best of all turns, which a motion
/// along nearly one line leaves open. Nothing if the scans hardly move.
std::vector<Eigen::Matrix3d> turns_on_body(const Samples& samples,
                                           const std::vector<SeenMotion>& seen);

/// "90 degrees about z", or roll, pitch and yaw.
std::string turn_text(const Eigen::Matrix3d& turn);

/// "0,0,0,0,0,0.70711,0.70711": what `--T-sensor` says of a sensor in the middle of the body.
std::string mounting_text(const Eigen::Matrix3d& turn);

}  // namespace raymoval::inspection
