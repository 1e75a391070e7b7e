// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/scan_heads.h"

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/bags/messages/point_cloud.h"

namespace raymoval {
namespace {

/// Messages that are left out, by the reason.
struct LeftOut {
  std::size_t empty = 0, damaged = 0;
  std::string first_damage;

  [[nodiscard]] std::size_t all() const { return empty + damaged; }
  [[nodiscard]] std::string text() const {
    std::vector<std::string> parts;
    if (empty > 0) parts.push_back(grouped_text(empty) + " without a point");
    if (damaged > 0) {
      parts.push_back(grouped_text(damaged) + " that cannot be read, the first: " + first_damage);
    }
    return join(parts);
  }
};

class HeadReader {
 public:
  HeadReader(const Bag& bag, std::size_t topic) : bag_(bag), topic_(topic) {}

  /// Nothing if the message is to be left out, which is counted.
  std::optional<PointsHead> read(std::size_t message, LeftOut& left_out) const {
    try {
      PointsHead head = head_of(message);
      if (head.header.stamp == 0) head.header.stamp = bag_.recorded(topic_, message);
      if (head.size > 0) return head;
      ++left_out.empty;
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError& error) {
      if (left_out.damaged++ == 0) left_out.first_damage = error.what();
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] PointsHead head_of(std::size_t message) const {
    const BagTopic& topic = bag_.topics()[topic_];
    const std::string place = message_place(bag_, topic_, message);
    const auto read = [&](const std::string& bytes) {
      return read_points_head(bytes, topic.type, topic.encoding, place);
    };
    const std::string begin = bag_.message_head(topic_, message, kHeaderBytes);
    if (begin.size() < kHeaderBytes) return read(begin);
    if (auto head = if_whole([&] { return read(begin); })) return *std::move(head);
    return read(bag_.message(topic_, message));
  }

  const Bag& bag_;
  std::size_t topic_;
};

/// The numbers of messages that `range` chooses.
ChosenFrames choose_messages(const Bag& bag, std::size_t topic, const FrameRange& range) {
  std::vector<NumberedFile> all;
  for (std::uint64_t i = 0; i < bag.topics()[topic].messages; ++i) {
    all.push_back({static_cast<long>(i), {}});
  }
  return choose_frames(all, range, bag_name(bag) + ": " + bag.topics()[topic].name);
}

}  // namespace

ScanHeads read_scan_heads(const Bag& bag, std::size_t topic, const FrameRange& range,
                          const std::atomic<bool>* cancel) {
  const HeadReader reader(bag, topic);
  const ChosenFrames chosen = choose_messages(bag, topic, range);
  ScanHeads heads;
  heads.range = chosen.range;
  LeftOut left_out;
  for (const NumberedFile& file : chosen.files) {
    if (cancel != nullptr && cancel->load()) throw Cancelled();
    const auto message = static_cast<std::size_t>(file.number);
    const auto head = reader.read(message, left_out);
    if (!head) continue;
    if (heads.messages.empty()) {
      heads.frame = head->header.frame_id;
    } else if (head->header.frame_id != heads.frame) {
      throw DataError(message_place(bag, topic, message) + ": its points are in frame '" +
                      head->header.frame_id + "', those of earlier messages in '" + heads.frame +
                      "'; one sensor has one frame. Filter the bag so that one is left.");
    }
    heads.messages.push_back(message);
    heads.stamps.push_back(head->header.stamp);
    const bool same = !heads.layouts.empty() && *heads.layouts.back() == head->layout;
    heads.layouts.push_back(same ? heads.layouts.back()
                                 : std::make_shared<const RecordLayout>(head->layout));
  }
  if (left_out.all() > 0) {
    heads.losses.push_back(bag_name(bag) + ": " + bag.topics()[topic].name + ": " +
                           counted_text(left_out.all(), "message") + " of " +
                           grouped_text(chosen.files.size()) + " left out: " + left_out.text());
    if (2 * left_out.all() >= chosen.files.size()) throw DataError(heads.losses.back());
  }
  LeftOut ignored;
  heads.first_stamp = heads.stamps.front();
  if (heads.messages.front() > 0) {
    if (const auto first = reader.read(0, ignored)) heads.first_stamp = first->header.stamp;
  }
  return heads;
}

}  // namespace raymoval
