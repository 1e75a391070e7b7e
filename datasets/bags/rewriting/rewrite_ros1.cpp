// SPDX-License-Identifier: MIT
#include <optional>
#include <vector>

#include "datasets/bags/rewriting/rewrite_file.h"
#include "datasets/bags/ros1/ros1_writer.h"

namespace raymoval {
namespace {

/// Finds the numbers of messages that come in the order of the file.
class Numbering {
 public:
  explicit Numbering(const Bag& bag) : bag_(bag), last_(bag.topics().size()) {}

  /// @return nothing if the bag has no such message
  std::optional<std::size_t> number(std::size_t topic, Nanoseconds recorded) {
    Last& last = last_[topic];
    const std::uint64_t count = bag_.topics()[topic].messages;
    if (last.numbers.empty()) last.numbers.resize(count);
    std::size_t at = last.recorded == recorded ? last.next : first_of(topic, recorded);
    while (at < count && bag_.recorded(topic, at) == recorded && last.numbers[at]) ++at;
    if (at >= count || bag_.recorded(topic, at) != recorded) return std::nullopt;
    last.numbers[at] = true;
    last.recorded = recorded;
    last.next = at + 1;
    return at;
  }

 private:
  struct Last {
    std::optional<Nanoseconds> recorded;
    std::size_t next = 0;
    std::vector<bool> numbers;  ///< Those that were given.
  };

  [[nodiscard]] std::size_t first_of(std::size_t topic, Nanoseconds recorded) const {
    std::size_t first = 0, behind = bag_.topics()[topic].messages;
    while (first < behind) {
      const std::size_t middle = first + (behind - first) / 2;
      if (bag_.recorded(topic, middle) < recorded) {
        first = middle + 1;
      } else {
        behind = middle;
      }
    }
    return first;
  }

  const Bag& bag_;
  std::vector<Last> last_;
};

}  // namespace

void rewrite_ros1(const Ros1Bag& bag, FileWriter& output, const ChangeMessage& change) {
  Ros1Writer writer(output);
  Numbering numbers(bag);
  for (std::size_t chunk = 0; chunk < bag.chunks().size(); ++chunk) {
    writer.begin_chunk(bag.chunks()[chunk].compression);
    bag.for_each_message(chunk, [&](const Ros1Bag::StoredMessage& message) {
      const auto index = numbers.number(message.topic, message.recorded);
      if (!index) return;
      const auto changed = change(message.topic, *index, message.bytes);
      if (!changed) return;
      writer.message(bag.connections().at(message.connection), message.recorded, *changed);
    });
    writer.end_chunk();
  }
  writer.finish();
}

}  // namespace raymoval
