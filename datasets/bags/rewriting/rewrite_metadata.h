// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "datasets/bags/ros2/metadata.h"

namespace raymoval {

/// How many messages are in a recording that was written again.
struct WrittenCounts {
  /// By the topic's name and its type, as `BagTopic` has them.
  std::map<std::pair<std::string, std::string>, std::uint64_t> topics;
  /// Of each of `Ros2Metadata::files`; nothing for one that is not in the new recording.
  std::vector<std::optional<std::uint64_t>> files;
};

/// The text of metadata.yaml of a recording written again to the folder `name`: the counts of
/// messages are new, files that are missing are not listed, and everything else stays as it was.
std::string rewritten_metadata(const Ros2Metadata& metadata, const std::string& name,
                               const WrittenCounts& counts);

}  // namespace raymoval
