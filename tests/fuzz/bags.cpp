// SPDX-License-Identifier: MIT
// Recordings, and what describes them.
#include "datasets/bags/bag.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

/// Reads all messages of a recording.
void read_recording(const std::filesystem::path& path, std::size_t size) {
  may_refuse([&] {
    const auto bag = open_bag(path);
    std::uint64_t count = 0;
    for (std::size_t topic = 0; topic < bag->topics().size(); ++topic) {
      for (std::size_t i = 0; i < bag->topics()[topic].messages; ++i) {
        require(i == 0 || bag->recorded(topic, i - 1) <= bag->recorded(topic, i),
                "messages are not in the order of their times");
        if (++count <= 100) may_refuse([&] { (void)bag->message(topic, i); });
      }
    }
    require(count <= size / 2 + 65536, "a file has more messages than it can hold");
    require(bag->damage().size() <= 16, "there is no end of notes on damage");
  });
}

RAYMOVAL_FUZZ_TARGET(bag_mcap) {
  // Anything is tried as MCAP.
  const bool begins = bytes.starts_with("\x89MCAP0\r\n");
  const std::string all = begins ? std::string(bytes) : "\x89MCAP0\r\n" + std::string(bytes);
  read_recording(input_file("bag.mcap", all), all.size());
}

RAYMOVAL_FUZZ_TARGET(bag_db3) {
  read_recording(input_file("bag.db3", bytes), bytes.size());
}

RAYMOVAL_FUZZ_TARGET(bag_metadata) {
  const auto path = input_file("metadata.yaml", bytes);
  may_refuse([&] { (void)open_bag(path.parent_path()); });
}

}  // namespace
}  // namespace raymoval::fuzz
