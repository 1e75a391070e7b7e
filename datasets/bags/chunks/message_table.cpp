// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/message_table.h"

#include <algorithm>

#include "core/error.h"

namespace raymoval {

std::size_t MessageTable::topic(const std::string& name, const std::string& type,
                                MessageEncoding encoding, const std::string& key) {
  const auto [found, is_new] = numbers_.try_emplace(Key(name, type, encoding, key), topics_.size());
  if (is_new) {
    topics_.push_back({name, type, encoding, 0});
    messages_.emplace_back();
  }
  return found->second;
}

void MessageTable::add(std::size_t topic, const Message& message) {
  messages_.at(topic).push_back(message);
  ++topics_[topic].messages;
  ++size_;
}

void MessageTable::finish() {
  for (std::deque<Message>& messages : messages_) {
    if (!std::is_sorted(messages.begin(), messages.end())) {
      std::sort(messages.begin(), messages.end());
    }
  }
}

const MessageTable::Message& MessageTable::at(std::size_t topic, std::size_t index) const {
  if (topic < messages_.size() && index < messages_[topic].size()) return messages_[topic][index];
  throw InternalError("a message of a bag is asked for that does not exist");
}

std::optional<std::size_t> MessageTable::index_of(std::size_t topic, const Message& message) const {
  const std::deque<Message>& messages = messages_.at(topic);
  const auto found = std::lower_bound(messages.begin(), messages.end(), message);
  if (found == messages.end() || *found != message) return std::nullopt;
  return static_cast<std::size_t>(found - messages.begin());
}

std::string ros1_type_name(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

}  // namespace raymoval
