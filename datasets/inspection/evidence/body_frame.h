// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "datasets/inspection/evidence/pair_fit.h"

namespace raymoval::inspection {

/// Whether the sensor turns by about the angles that its poses turn by, about whatever axis. This
/// does not depend on how the sensor is turned on the body that has the poses.
bool turns_as_much(const Samples& samples, const std::vector<SeenMotion>& seen);

/// R_body_sensor under which the poses of a body move as the scans do, whatever its position on the
/// body. Motion along one line leaves the turn about that line open; then z stays as near to z as
/// it can. Nothing if the scans hardly move.
std::optional<Eigen::Matrix3d> turn_on_body(const Samples& samples,
                                            const std::vector<SeenMotion>& seen);

/// "90 degrees about z", or roll, pitch and yaw.
std::string turn_text(const Eigen::Matrix3d& turn);

/// "0,0,0,0,0,0.70711,0.70711": what `--T-sensor` says of a sensor in the middle of the body.
std::string mounting_text(const Eigen::Matrix3d& turn);

}  // namespace raymoval::inspection
