// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/clouds/frames.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// What the messages of a topic with scans say before their points.
struct ScanHeads {
  std::vector<std::size_t> messages;  ///< Numbers of those that can be used, in order.
  std::vector<Nanoseconds> stamps;    ///< Of each of these.
  /// The layout of the points of each of these; equal ones are one.
  std::vector<std::shared_ptr<const RecordLayout>> layouts;
  Nanoseconds first_stamp = 0;      ///< Of the topic's first message that can be used.
  std::string frame;                ///< That all points are in.
  FrameRange range;                 ///< As used, with both ends.
  std::vector<std::string> losses;  ///< Whole sentences on messages that are left out.
};

/// Reads the heads of the messages that `range` chooses. Messages without a point, or that cannot
/// be read, are left out. Those without a stamp have the time at which they were recorded.
/// @throws DataError if the range reaches outside the topic, if half of the messages or more cannot
///   be used, or if their frames differ; Cancelled; UnreadableError if the disk fails
ScanHeads read_scan_heads(const Bag& bag, std::size_t topic, const FrameRange& range,
                          const std::atomic<bool>* cancel);

}  // namespace raymoval
