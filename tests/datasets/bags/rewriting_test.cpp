// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <tuple>

#include "core/error.h"
#include "datasets/bags/chunks/pack.h"
#include "datasets/bags/rewriting/rewrite_bag.h"
#include "tests/datasets/bags/recordings.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval {
namespace {

using test::TemporaryFolder;

std::optional<std::string> same(std::size_t, std::size_t, const std::string& message) {
  return message;
}

/// Makes "points 1" longer and leaves out "points 2".
std::optional<std::string> changed(std::size_t, std::size_t index, const std::string& message) {
  if (message.find("points") == std::string::npos) return message;
  CHECK(message.substr(4) == "points " + std::to_string(index));
  if (index == 2) return std::nullopt;
  return index == 1 ? message + " without its movers" : message;
}

void check_changed(const std::filesystem::path& path) {
  const auto bag = open_bag(path);
  CHECK(test::texts_of(*bag, "/points") ==
        std::vector<std::string>{"points 0", "points 1 without its movers"});
  CHECK(test::texts_of(*bag, "/pose") == std::vector<std::string>{"pose 0", "pose 1"});
  CHECK(bag->recorded(test::topic_named(*bag, "/points"), 1) == 2000);
  CHECK(bag->damage().empty());
}

TEST_CASE("A recording in one file is written again in its own container", "[bags][rewriting]") {
  const std::string name =
      GENERATE("bag_mcap/chunks.mcap", "bag_mcap/zstd.mcap", "bag_mcap/lz4.mcap",
               "bag_mcap/no_chunks.mcap", "bag_mcap/bare.mcap", "bag_db3/small.db3");
  CAPTURE(name);
  const TemporaryFolder folder;
  const auto input = test::recording(name);
  const auto output = folder.path() / ("out" + input.extension().string());
  const RewrittenBag as_it_was = rewrite_bag(input, output, same);
  CHECK(as_it_was.messages == 5);
  CHECK(as_it_was.changed == 0);
  test::check_content(*open_bag(output));

  const RewrittenBag result = rewrite_bag(input, output, changed);
  CHECK(result.changed == 1);
  CHECK(result.left_out == 1);
  check_changed(output);
}

/// All messages of a ROS 1 bag: topic, time, bytes.
std::vector<std::tuple<std::string, Nanoseconds, std::string>> messages_of(
    const std::filesystem::path& path) {
  std::vector<std::tuple<std::string, Nanoseconds, std::string>> all;
  const auto bag = open_bag(path);
  CHECK(bag->damage().empty());
  for (std::size_t topic = 0; topic < bag->topics().size(); ++topic) {
    for (std::size_t i = 0; i < bag->topics()[topic].messages; ++i) {
      all.emplace_back(bag->topics()[topic].name, bag->recorded(topic, i), bag->message(topic, i));
    }
  }
  return all;
}

TEST_CASE("A ROS 1 bag is written again with its compression", "[bags][rewriting][ros1]") {
  const std::string packing = GENERATE("none", "bz2", "lz4");
  CAPTURE(packing);
  const TemporaryFolder folder;
  const auto input = test::recording("bag_ros1/rosbag_" + packing + ".bag");
  const RewrittenBag as_it_was = rewrite_bag(input, folder / "same.bag", same);
  auto wanted = messages_of(input);
  CHECK(as_it_was.messages == 5);
  CHECK(as_it_was.changed == 0);
  CHECK(messages_of(folder / "same.bag") == wanted);
  CHECK_THAT(test::file_bytes(folder / "same.bag"), Catch::Contains("compression=" + packing));

  const std::size_t points = test::topic_named(*open_bag(input), "/points");
  const auto change = [&](std::size_t topic, std::size_t index,
                          const std::string& message) -> std::optional<std::string> {
    if (topic != points) return message;
    return index == 1 ? std::nullopt : std::optional(message + std::string(index, '!'));
  };
  const RewrittenBag result = rewrite_bag(input, folder / "out.bag", change);
  CHECK(result.changed == 1);
  CHECK(result.left_out == 1);
  std::size_t number = 0, left_out = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (std::get<0>(wanted[i]) != "/points") continue;
    if (number == 1) left_out = i;
    std::get<2>(wanted[i]) += std::string(number++, '!');
  }
  wanted.erase(wanted.begin() + static_cast<std::ptrdiff_t>(left_out));
  CHECK(messages_of(folder / "out.bag") == wanted);
}

TEST_CASE("A ROS 1 bag with another bag's messages cut off is written whole",
          "[bags][rewriting][ros1]") {
  const TemporaryFolder folder;
  const std::string whole = test::file_bytes(test::recording("bag_ros1/rosbag_none.bag"));
  const auto input = folder.write("cut.bag", whole.substr(0, whole.size() * 3 / 4));
  const RewrittenBag result = rewrite_bag(input, folder / "out.bag", same);
  CHECK_FALSE(result.damage.empty());
  CHECK(result.messages > 0);
  CHECK(messages_of(folder / "out.bag").size() == result.messages);  // And without damage.
}

TEST_CASE("Messages that are packed one by one are read, and stay packed", "[bags][rewriting]") {
  const TemporaryFolder folder;
  folder.write("drive/packed.db3", test::file_bytes(test::recording("bag_db3/packed.db3")));
  folder.write("drive/metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
               "  compression_format: zstd\n  compression_mode: MESSAGE\n"
               "  relative_file_paths:\n    - packed.db3\n");
  test::check_content(*open_bag(folder / "drive"));
  std::filesystem::create_directory(folder / "clean");  // An empty one is no obstacle.
  rewrite_bag(folder / "drive", folder / "clean", changed);
  check_changed(folder / "clean");
  CHECK_THAT(test::file_bytes(folder / "clean/packed.db3"),
             Catch::Contains("\x28\xB5\x2F\xFD"));  // zstd's magic number.
  // Damage of one message is said with its place, and the others are read.
  std::string bytes = test::file_bytes(test::recording("bag_db3/packed.db3"));
  bytes.replace(bytes.find("points 0") - 8, 4, "XXXX");
  folder.write("drive/packed.db3", bytes);
  const auto bag = open_bag(folder / "drive");
  const std::size_t points = test::topic_named(*bag, "/points");
  CHECK_THROWS_AS(bag->message(points, 0), DataError);
  CHECK(bag->message(points, 1).substr(4) == "points 1");
}

TEST_CASE("What is no message stays in a MCAP file", "[bags][rewriting]") {
  const TemporaryFolder folder;
  rewrite_bag(test::recording("bag_mcap/zstd.mcap"), folder / "out.mcap", changed);
  const std::string bytes = test::file_bytes(folder / "out.mcap");
  for (const char* text : {"note.txt", "wheels", "offered_qos_profiles", "ros2msg"}) {
    CHECK(bytes.find(text) != std::string::npos);
  }
}

TEST_CASE("A folder is written to a new one with its metadata", "[bags][rewriting]") {
  const TemporaryFolder folder;
  const bool packed = GENERATE(false, true);
  const std::string name = packed ? "a.db3.zstd" : "a.db3";
  const std::string bytes = test::file_bytes(test::recording("bag_db3/small.db3"));
  folder.write("drive/" + name, packed ? pack_zstd(bytes) : bytes);
  folder.write(
      "drive/metadata.yaml",
      "rosbag2_bagfile_information:\n  version: 3\n  storage_identifier: sqlite3\n"
      "  duration:\n    nanoseconds: 2000\n  starting_time:\n    nanoseconds_since_epoch: 1000\n"
      "  message_count: 5  # all\n  topics_with_message_count:\n"
      "    - topic_metadata:\n        name: /points\n"
      "        type: sensor_msgs/msg/PointCloud2\n      message_count: 3\n"
      "    - topic_metadata:\n        name: /pose\n"
      "        type: geometry_msgs/msg/PoseStamped\n      message_count: 2\n" +
          std::string(packed ? "  compression_format: zstd\n  compression_mode: FILE\n" : "") +
          "  relative_file_paths:\n    - drive/" + name + "\n    - drive/gone.db3\n");
  rewrite_bag(folder / "drive", folder / "clean", changed);
  check_changed(folder / "clean");
  const std::string text = test::file_bytes(folder / "clean/metadata.yaml");
  CHECK_THAT(text, Catch::Contains("message_count: 4  # all"));
  // The last message, of time 3000, is left out.
  CHECK_THAT(text, Catch::Contains("duration:\n    nanoseconds: 1000\n") &&
                       Catch::Contains("nanoseconds_since_epoch: 1000\n"));
  CHECK_THAT(text, Catch::Contains("PointCloud2\n      message_count: 2\n"));
  CHECK_THAT(text, Catch::EndsWith("    - clean/" + name + "\n"));
  CHECK_THROWS_WITH(rewrite_bag(folder / "drive", folder / "clean", same),
                    Catch::Contains("is there already"));
}

TEST_CASE("An error of the change goes through and leaves nothing behind", "[bags][rewriting]") {
  const TemporaryFolder folder;
  const std::string name = GENERATE("bag_mcap/zstd.mcap", "bag_db3/small.db3");
  const std::string ending = std::filesystem::path(name).extension().string();
  // A recording that is cut is no reason to take the error for damage.
  const std::string whole = test::file_bytes(test::recording(name));
  const bool is_mcap = ending == ".mcap";
  const auto input =
      folder.write("in" + ending, is_mcap ? whole.substr(0, whole.size() * 2 / 3) : whole);
  const auto fail = [](std::size_t, std::size_t, const std::string&) -> std::optional<std::string> {
    throw DataError("cannot be changed");
  };
  CHECK_THROWS_WITH(rewrite_bag(input, folder / ("out" + ending), fail), "cannot be changed");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder.path())) {
    ++files;
  }
  CHECK(files == 1);
}

TEST_CASE("Of a cut recording what can be read is written, and damage is said",
          "[bags][rewriting]") {
  const TemporaryFolder folder;
  const std::string whole = test::file_bytes(test::recording("bag_mcap/chunks.mcap"));
  for (std::size_t size = 600; size < whole.size(); size += 211) {
    CAPTURE(size);
    const auto input = folder.write("in_" + std::to_string(size) + ".mcap", whole.substr(0, size));
    try {
      const RewrittenBag result = rewrite_bag(input, folder / "out.mcap", same);
      CHECK_FALSE(result.damage.empty());
      const auto before = open_bag(input), after = open_bag(folder / "out.mcap");
      CHECK(after->damage().empty());
      CHECK(test::texts_of(*after, "/points") == test::texts_of(*before, "/points"));
    } catch (const DataError& error) {
      CHECK_THAT(error.what(), Catch::Contains("no message"));
    }
  }
}

TEST_CASE("A recording is not written to a name of another container", "[bags][rewriting]") {
  const TemporaryFolder folder;
  const auto input = test::recording("bag_db3/small.db3");
  CHECK_THROWS_WITH(check_rewriting(input, folder / "out.mcap"), Catch::Contains(".db3"));
  CHECK_THROWS_WITH(check_rewriting(input, input),
                    Catch::Contains("is the recording that is read"));
  CHECK_NOTHROW(check_rewriting(input, folder / "out.db3"));
}

}  // namespace
}  // namespace raymoval
