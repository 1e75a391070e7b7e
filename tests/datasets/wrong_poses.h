// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <utility>

#include "datasets/simulation/street/street.h"
#include "tests/methods/held_scans.h"

namespace raymoval::test {

/// The exact street, whose sensor moves 1 m per scan, with poses with an error in their position.
/// @param error metres, by the index of the scan
inline toy::ChangedScans wrong_poses(std::function<Eigen::Vector3d(std::size_t)> error,
                                     const SequenceOptions& options = {}) {
  return {make_street({}, street_boxes(), options).scans, [error = std::move(error)](Scan& scan) {
            scan.T_world_sensor.translation() += error(scan.index);
          }};
}

}  // namespace raymoval::test
