// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "datasets/bags/bag.h"

namespace raymoval::test {

/// A recording that another program wrote, see make_mcap.mjs and make_db3.py.
inline std::filesystem::path recording(const std::string& name) {
  return std::filesystem::path(RAYMOVAL_SOURCE_DIR) / "tests/fuzz/corpus" / name;
}

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The number of the topic `name`.
inline std::size_t topic_named(const Bag& bag, const std::string& name) {
  const auto& topics = bag.topics();
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const BagTopic& topic) { return topic.name == name; });
  REQUIRE(found != topics.end());
  return static_cast<std::size_t>(found - topics.begin());
}

/// What was published in a message, behind CDR's head of four bytes.
inline std::string text_of(const Bag& bag, const std::string& topic, std::size_t index) {
  return bag.message(topic_named(bag, topic), index).substr(4);
}

inline std::vector<std::string> texts_of(const Bag& bag, const std::string& topic) {
  std::vector<std::string> texts;
  const std::size_t number = topic_named(bag, topic);
  for (std::size_t i = 0; i < bag.topics()[number].messages; ++i) {
    texts.push_back(text_of(bag, topic, i));
  }
  return texts;
}

/// Checks what all of these recordings hold: messages in the order of their times, and two of the
/// same time in that of the file.
inline void check_content(const Bag& bag) {
  CHECK(texts_of(bag, "/points") == std::vector<std::string>{"points 0", "points 1", "points 2"});
  CHECK(texts_of(bag, "/pose") == std::vector<std::string>{"pose 0", "pose 1"});
  const std::size_t points = topic_named(bag, "/points");
  CHECK(bag.topics().size() == 2);
  CHECK(bag.topics()[points].type == "sensor_msgs/PointCloud2");
  CHECK(bag.topics()[points].encoding == MessageEncoding::kCdr);
  CHECK(bag.recorded(points, 1) == 2000);
  CHECK(bag.damage().empty());
  // Before and after the messages themselves were read.
  for (std::size_t most : {0, 5, 11, 4096}) {
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(bag.message_head(points, i, most) == bag.message(points, i).substr(0, most));
    }
  }
}

/// Calls `call`, which may throw a DataError that says something, and nothing else.
template <class Call>
void may_refuse(Call&& call) {
  try {
    call();
  } catch (const DataError& error) {
    CHECK(std::string(error.what()).size() > 20);
  }
}

/// Calls `call` with the topic and number of each message.
template <class Call>
void for_each_message(const Bag& bag, Call&& call) {
  for (std::size_t topic = 0; topic < bag.topics().size(); ++topic) {
    for (std::size_t i = 0; i < bag.topics()[topic].messages; ++i) call(topic, i);
  }
}

/// Opens a truncated or damaged recording and reads all messages. Each must be a message of the
/// whole recording, and damage must be reported. @return number of messages
inline std::uint64_t read_damaged(const std::filesystem::path& path) {
  std::uint64_t count = 0;
  may_refuse([&] {
    const auto bag = open_bag(path);
    CHECK_FALSE(bag->damage().empty());
    for_each_message(*bag, [&](std::size_t topic, std::size_t i) {
      const std::string text = bag->message(topic, i).substr(4);
      CHECK((text.starts_with("points ") || text.starts_with("pose ")));
      ++count;
    });
  });
  return count;
}

}  // namespace raymoval::test
