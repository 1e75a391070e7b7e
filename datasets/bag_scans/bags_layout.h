// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/layout.h"

namespace raymoval {

/// Recordings of ROS messages: ROS 1 bags, MCAP, and what ROS 2 records. The scans are the messages
/// of a topic; a scan's number is that of its message, from 0. Their times are those in their
/// headers.
Layout bags_layout();

}  // namespace raymoval
