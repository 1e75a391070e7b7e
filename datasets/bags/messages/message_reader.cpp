// SPDX-License-Identifier: MIT
#include "datasets/bags/messages/message_reader.h"

#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Bytes before a CDR body: two for its kind, two for options.
constexpr std::size_t kCdrHead = 4;

}  // namespace

MessageReader::MessageReader(std::string_view bytes, MessageEncoding encoding, std::string where)
    : bytes_(bytes), where_(std::move(where)) {
  if (encoding == MessageEncoding::kRos1) return;
  if (encoding != MessageEncoding::kCdr) {
    throw DataError(where_ + ": is encoded neither as ROS 1 nor as CDR, which is not read.");
  }
  is_cdr_ = true;
  const std::string_view head = take(kCdrHead, "the head of CDR");
  const auto kind = static_cast<unsigned char>(head[1]);
  if (head[0] != 0 || kind > 1) {
    throw DataError(where_ + ": its CDR is of kind " +
                    std::to_string(static_cast<unsigned char>(head[0])) + "." +
                    std::to_string(kind) +
                    ", expected plain CDR (0.0 or 0.1), which ROS 2 writes. Record it with the "
                    "middleware's usual encoding.");
  }
  big_endian_ = kind == 0;
}

void MessageReader::fail(const std::string& what) const {
  throw DataError(where_ + ": " + what);
}

std::size_t MessageReader::aligned_position(std::size_t size) const {
  if (!is_cdr_) return position_;
  const std::size_t body = position_ - kCdrHead;
  return kCdrHead + (body + size - 1) / size * size;
}

std::string_view MessageReader::take(std::size_t size, const char* field) {
  // Padding may end behind the end of the message.
  const std::size_t left = bytes_.size() - std::min(position_, bytes_.size());
  if (position_ > bytes_.size() || size > left) {
    fail("its " + std::string(field) + " takes " + counted_text(size, "byte") + " from byte " +
         grouped_text(position_) + " on, but the message has " + grouped_text(bytes_.size()) +
         "; it is truncated or damaged, or not of the type that the bag names.");
  }
  const std::string_view taken = bytes_.substr(position_, size);
  position_ += size;
  return taken;
}

std::uint32_t MessageReader::count(const char* field, std::size_t least) {
  const auto count = number<std::uint32_t>(field);
  if (count > 0 && (bytes_.size() - position_) / least < count) {
    fail("its " + std::string(field) + " should have " + counted_text(count, "element") + ", but " +
         counted_text(bytes_.size() - position_, "byte") +
         " are left; it is truncated or damaged, or not of the type that the bag names.");
  }
  return count;
}

std::string MessageReader::text(const char* field) {
  std::string_view text = take(count(field, 1), field);
  // CDR counts the zero at the end of a text.
  if (is_cdr_ && text.ends_with('\0')) text.remove_suffix(1);
  return std::string(text);
}

MessageHeader read_message_header(MessageReader& reader) {
  constexpr Nanoseconds kSecond = 1'000'000'000;
  MessageHeader header;
  if (!reader.is_cdr()) reader.number<std::uint32_t>("header.seq");
  // ROS 2 has a sign here, ROS 1 a second half of this era that begins in 2038.
  const Nanoseconds seconds =
      reader.is_cdr() ? static_cast<Nanoseconds>(reader.number<std::int32_t>("header.stamp"))
                      : static_cast<Nanoseconds>(reader.number<std::uint32_t>("header.stamp"));
  header.stamp = seconds * kSecond + reader.number<std::uint32_t>("header.stamp");
  header.frame_id = reader.text("header.frame_id");
  return header;
}

}  // namespace raymoval
