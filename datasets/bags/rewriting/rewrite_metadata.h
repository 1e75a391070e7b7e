// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "datasets/bags/ros2/metadata.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// The messages of a file that was written again.
struct WrittenMessages {
  std::uint64_t count = 0;
  Nanoseconds first = 0, last = 0;  ///< When they were recorded; 0 if there is none.

  void add(Nanoseconds recorded) {
    first = count == 0 ? recorded : std::min(first, recorded);
    last = count == 0 ? recorded : std::max(last, recorded);
    ++count;
  }
};

/// How many messages are in a recording that was written again.
struct WrittenCounts {
  /// By the topic's name and its type, as `BagTopic` has them.
  std::map<std::pair<std::string, std::string>, std::uint64_t> topics;
  /// Of each of `Ros2Metadata::files`; nothing for one that is not in the new recording.
  std::vector<std::optional<WrittenMessages>> files;
};

/// The text of metadata.yaml of a recording written again to the folder `name`: the counts of
/// messages are new, so are times where messages are missing, files that are missing are not
/// listed, and everything else stays as it was.
std::string rewritten_metadata(const Ros2Metadata& metadata, const std::string& name,
                               const WrittenCounts& counts);

}  // namespace raymoval
