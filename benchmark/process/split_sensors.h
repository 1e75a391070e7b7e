// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "datasets/sequence.h"
#include "methods/remover.h"

namespace raymoval {

/// The spin axis of the sensor in the frame of the points, as the scans show it: a unit vector.
/// Also points of a known sensor may be in the frame of a vehicle, an IMU or a camera. It is +z for
/// merged clouds, which have no axis before they are split.
/// @throws DataError if a scan cannot be read
Eigen::Vector3d spin_axis_of(const Sequence& sequence);

/// `method` for merged clouds of several sensors: it gets each cloud as one scan for each sensor,
/// in the order of the sensors' numbers, whose points and pose have their origin where the beams
/// of that sensor start. Its answers are put together again, so that masks have the indices of the
/// merged clouds. Points within 5 cm of their sensor are missing returns and are kept.
/// @param sequence with `sensor_origin`; must outlive the result
/// @return `method` itself if the sequence is not of merged clouds
std::unique_ptr<Remover> with_split_sensors(std::unique_ptr<Remover> method,
                                            const Sequence& sequence);

}  // namespace raymoval
