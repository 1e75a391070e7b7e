// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/topics.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::vector<std::string> texts_of(const Bag& bag, const std::vector<std::size_t>& topics) {
  std::vector<std::string> texts;
  for (const std::size_t topic : topics) texts.push_back(topic_text(bag.topics()[topic]));
  return texts;
}

std::size_t named_topic(const Bag& bag, const std::string& name, const TopicRequest& wish) {
  std::vector<std::size_t> of_name, fitting;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    names.push_back(topic.name);
    if (topic.name != name && topic.name != "/" + name) continue;
    of_name.push_back(i);
    if (wish.fits(topic)) fitting.push_back(i);
  }
  const std::string asked = bag_name(bag) + ": " + wish.option + " " + name + ": ";
  if (of_name.empty()) {
    const auto near = closest_name(name, names);
    throw UsageError(asked + "there is no such topic." +
                     (near ? " Did you mean '" + *near + "'? " : " ") + topics_sentence(bag));
  }
  if (fitting.empty()) {
    throw UsageError(asked + "is no topic " + wish.kind + ", but " +
                     topic_text(bag.topics()[of_name[0]]) + ". " + topics_sentence(bag));
  }
  if (fitting.size() > 1) {
    throw UsageError(asked + "there are several topics of this name, with different types: " +
                     join(texts_of(bag, fitting)) + ". Filter the bag to one of them.");
  }
  return fitting[0];
}

}  // namespace

std::string bag_name(const Bag& bag) {
  return bag.path().filename().string();
}

std::string topic_text(const BagTopic& topic) {
  return topic.name + " (" + topic.type + ", " + counted_text(topic.messages, "message") + ")";
}

std::string topics_sentence(const Bag& bag) {
  constexpr std::size_t kMost = 30;
  std::vector<std::string> texts;
  for (const BagTopic& topic : bag.topics()) texts.push_back(topic_text(topic));
  if (texts.empty()) return "It has no topic.";
  std::sort(texts.begin(), texts.end());
  const std::size_t more = texts.size() - std::min(texts.size(), kMost);
  texts.resize(std::min(texts.size(), kMost));
  return "It has " + join(texts) + (more > 0 ? " and " + grouped_text(more) + " more" : "") + ".";
}

std::string message_place(const Bag& bag, std::size_t topic, std::size_t message) {
  return bag_name(bag) + ": " + bag.topics()[topic].name + ", message " + std::to_string(message);
}

std::optional<std::size_t> choose_topic(const Bag& bag, const std::optional<std::string>& named,
                                        const TopicRequest& wish) {
  if (named) return named_topic(bag, *named, wish);
  std::vector<std::size_t> fitting;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    if (bag.topics()[i].messages > 0 && wish.fits(bag.topics()[i])) fitting.push_back(i);
  }
  if (fitting.empty()) return std::nullopt;
  if (fitting.size() == 1) return fitting[0];
  std::vector<std::string> names;
  for (const std::size_t topic : fitting) names.push_back(bag.topics()[topic].name);
  throw UsageError(bag_name(bag) + ": has several topics " + wish.kind + ": " +
                   join(texts_of(bag, fitting)) + ". Name one with " + wish.option +
                   (wish.several ? ", or those of several sensors of one vehicle: " + wish.option +
                                       " " + join(names, ",") + "."
                                 : "."));
}

}  // namespace raymoval
