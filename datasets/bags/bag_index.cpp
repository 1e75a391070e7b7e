// SPDX-License-Identifier: MIT
#include "datasets/bags/bag_index.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {

void DamageNotes::add(std::string sentence) {
  const std::lock_guard lock(mutex_);
  if (std::find(kept_.begin(), kept_.end(), sentence) != kept_.end()) return;
  if (kept_.size() < kMost) {
    kept_.push_back(std::move(sentence));
  } else {
    ++more_;
  }
}

std::vector<std::string> DamageNotes::sentences() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all = kept_;
  if (more_ > 0) {
    all.push_back("Further damage was found in " + counted_text(more_, "place") +
                  ", not listed here.");
  }
  return all;
}

bool DamageNotes::empty() const {
  const std::lock_guard lock(mutex_);
  return kept_.empty();
}

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

std::string ros1_type_name(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

}  // namespace raymoval
