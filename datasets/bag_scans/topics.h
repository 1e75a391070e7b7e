// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "datasets/bags/bag.h"

namespace raymoval {

/// "drive.bag", to begin messages.
std::string bag_name(const Bag& bag);
/// "/points (sensor_msgs/PointCloud2, 1,200 messages)".
std::string topic_text(const BagTopic& topic);
/// The topics of a bag for messages, the first thirty by name: "It has /imu (...), /points (...)."
std::string topics_sentence(const Bag& bag);
/// "drive.bag: /points, message 12".
std::string message_place(const Bag& bag, std::size_t topic, std::size_t message);

/// A description of the topic to choose.
struct TopicRequest {
  std::string option;  ///< The flag that names a topic: "--topic".
  std::string kind;    ///< "with scans (sensor_msgs/PointCloud2 or a Livox CustomMsg)".
  std::function<bool(const BagTopic&)> fits;
  bool several = false;  ///< Whether the flag takes several topics.
};

/// The topic that the user named, or the only topic that fits and has messages. Empty if no topic
/// was named and none fits.
/// @throws UsageError naming the topics of the bag, if the named topic is missing or does not fit,
///   or if several fit
std::optional<std::size_t> choose_topic(const Bag& bag, const std::optional<std::string>& named,
                                        const TopicRequest& wish);

}  // namespace raymoval
