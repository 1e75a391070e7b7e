// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

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
  for (std::size_t size = 600; size < whole.size(); size += 97) {
    CAPTURE(size);
    const auto input = folder.write("in.mcap", whole.substr(0, size));
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
