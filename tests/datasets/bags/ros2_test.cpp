// SPDX-License-Identifier: MIT
#include <sqlite3.h>
#include <zstd.h>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/datasets/bags/recordings.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval {
namespace {

using test::TemporaryFolder;

std::string db3_bytes() {
  return test::file_bytes(test::recording("bag_db3/small.db3"));
}

TEST_CASE("A database that another program wrote is read", "[bags][ros2]") {
  test::check_content(*open_bag(test::recording("bag_db3/small.db3")));
}

TEST_CASE("A database that is cut at any byte is read as far as it goes", "[bags][ros2]") {
  const TemporaryFolder folder;
  const std::string whole = test::file_bytes(test::recording("bag_db3/overflow.db3"));
  const auto path = folder.write("cut.db3", whole);
  for (std::size_t size = whole.size() - 1; size > 122; size -= 122) {
    CAPTURE(size);
    std::filesystem::resize_file(path, size);
    test::may_refuse([&] {
      const auto bag = open_bag(path);
      CHECK_FALSE(bag->damage().empty());
      test::for_each_message(*bag, [&](std::size_t topic, std::size_t i) {
        test::may_refuse([&] {
          const std::string text = bag->message(topic, i).substr(4);
          CHECK((text.starts_with("points ") || text.starts_with("pose ")));
        });
      });
    });
  }
}

TEST_CASE("A database whose pages contain each other does not hang", "[bags][ros2]") {
  const TemporaryFolder folder;
  const std::string whole = test::file_bytes(test::recording("bag_db3/overflow.db3"));
  for (std::size_t at = 100; at < whole.size(); at += 41) {
    std::string damaged = whole;
    for (std::size_t i = at; i < std::min(at + 4, damaged.size()); ++i) damaged[i] = 0x02;
    test::may_refuse([&] {
      const auto bag = open_bag(folder.write("damaged_" + std::to_string(at) + ".db3", damaged));
      test::for_each_message(*bag, [&](std::size_t topic, std::size_t i) {
        test::may_refuse([&] {
          const std::string text = bag->message(topic, i);
          CHECK(text.size() <= whole.size());
        });
      });
    });
  }
}

TEST_CASE("What a recorder left beside a database is not passed over", "[bags][ros2]") {
  const TemporaryFolder folder;
  const auto path = folder.write("a.db3", db3_bytes());
  folder.write("a.db3-wal", "");
  folder.write("a.db3-journal", std::string(600, '\0'));  // One that was ended has zeros.
  CHECK_NOTHROW(open_bag(path));
  folder.write("a.db3-journal", "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7 and pages");
  CHECK_THROWS_WITH(open_bag(path), Catch::Contains("a.db3-journal"));
  folder.write("a.db3-journal", "");
  folder.write("a.db3-wal", "pages");
  CHECK_THROWS_WITH(open_bag(path), Catch::Contains("wal_checkpoint"));
}

TEST_CASE("A database without the tables of a recording is refused", "[bags][ros2]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& sql, const std::string& problem = "no table") {
    const auto path = folder.write("other.db3", "");
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open(path.c_str(), &database) == SQLITE_OK);
    REQUIRE(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
    REQUIRE(sqlite3_close(database) == SQLITE_OK);
    CHECK_THROWS_WITH(open_bag(path), Catch::Contains(problem));
  };
  const std::string topics = "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, x);";
  refused(topics);
  refused(topics +
          "CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x+1 "
          "FROM c) SELECT x AS id, 1 AS topic_id, x AS timestamp, x AS data FROM c");
  refused(topics +
          "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data BLOB "
          "AS (zeroblob(1000000000)))");
  // Reading a list of tables takes a time that grows with the square of their number.
  refused(
      topics +
          "PRAGMA writable_schema=ON; WITH RECURSIVE c(i) AS (SELECT 1 UNION ALL SELECT i+1 "
          "FROM c WHERE i<30000) INSERT INTO sqlite_master(type, name, tbl_name, rootpage, sql) "
          "SELECT 'table', 't'||i, 't'||i, 2, 'CREATE TABLE t'||i||'(x)' FROM c",
      "too many tables");
}

std::string metadata(const std::string& version, const std::string& files,
                     const std::string& more = "") {
  return "rosbag2_bagfile_information:\n  version: " + version +
         "\n  storage_identifier: sqlite3\n  duration:\n    nanoseconds: 2000\n"
         "  topics_with_message_count:\n    - topic_metadata:\n        name: /points\n"
         "        type: sensor_msgs/msg/PointCloud2\n        serialization_format: cdr\n"
         "        offered_qos_profiles: \"- history: 3\\n  depth: 0\"\n      message_count: 3\n" +
         more + "  relative_file_paths:\n" + files;
}

TEST_CASE("A folder is read by its metadata, of old and new versions", "[bags][ros2]") {
  const TemporaryFolder folder;
  folder.write("drive/drive_0.db3", db3_bytes());
  const std::string version = GENERATE("1", "2", "3", "4", "5", "9");
  const std::string prefix = version < "4" ? "another_name/" : "";
  folder.write("drive/metadata.yaml",
               metadata(version, "    - " + prefix + "drive_0.db3\n", "  message_count: 5\n"));
  CAPTURE(version);
  REQUIRE(is_bag(folder / "drive"));
  test::check_content(*open_bag(folder / "drive"));
}

TEST_CASE("Several files are one recording, and what is wrong with them is said", "[bags][ros2]") {
  const TemporaryFolder folder;
  folder.write("drive/a.db3", db3_bytes());
  folder.write("drive/b.mcap", test::file_bytes(test::recording("bag_mcap/zstd.mcap")));
  folder.write("drive/metadata.yaml",
               metadata("5", "    - a.db3\n    - b.mcap\n    - a.db3\n    - gone.db3\n",
                        "  message_count: 11\n"));
  const auto bag = open_bag(folder / "drive");
  CHECK(test::texts_of(*bag, "/pose") ==
        std::vector<std::string>{"pose 0", "pose 1", "pose 0", "pose 1"});
  CHECK(test::texts_of(*bag, "/points").size() == 6);
  const auto damage = bag->damage();
  REQUIRE(damage.size() == 3);
  CHECK_THAT(damage[0], Catch::Contains("a.db3 twice"));
  CHECK_THAT(damage[1], Catch::Contains("gone.db3"));
  CHECK_THAT(damage[2], Catch::Contains("11 messages") && Catch::Contains("10 can"));
}

TEST_CASE("Packed files and packed messages are unpacked", "[bags][ros2]") {
  const TemporaryFolder folder;
  const std::string mode = "  compression_format: zstd\n  compression_mode: ";
  std::string packed(100000, '\0');
  packed.resize(
      ZSTD_compress(packed.data(), packed.size(), db3_bytes().data(), db3_bytes().size(), 1));
  folder.write("drive/a.db3.zstd", packed);
  folder.write("drive/metadata.yaml", metadata("5", "    - a.db3.zstd\n", mode + "FILE\n"));
  test::check_content(*open_bag(folder / "drive"));
  test::check_content(*open_bag(folder / "drive/a.db3.zstd"));
  folder.write("drive/metadata.yaml", metadata("5", "    - a.db3.zstd\n", mode + "OTHER\n"));
  CHECK_THROWS_AS(open_bag(folder / "drive"), UsageError);

  // A message of 8 bytes says of itself that it unpacks to 1 GiB.
  const std::string bomb("\x28\xb5\x2f\xfd\xa0\x00\x00\x00\x40\x03\x00\x00", 12);
  folder.write("bomb.mcap.zst", bomb);
  CHECK_THROWS_AS(open_bag(folder / "bomb.mcap.zst"), DataError);
}

TEST_CASE("Parts of a recording without metadata.yaml are one recording", "[bags][ros2]") {
  const TemporaryFolder folder;
  folder.write("drive/drive_0.db3", db3_bytes());
  CHECK(is_bag(folder / "drive"));
  test::check_content(*open_bag(folder / "drive"));
  folder.write("drive/drive_1.db3", db3_bytes());
  const auto bag = open_bag(folder / "drive");
  CHECK(test::texts_of(*bag, "/points").size() == 6);
  CHECK(bag->damage().empty());
  // Scans beside it are not the recording's.
  folder.write("drive/000000.pcd", "");
  CHECK_FALSE(is_bag(folder / "drive"));
}

TEST_CASE("Recordings that are known and not read are refused with a remedy", "[bags]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(open_bag(folder.write("old.bag", "#ROSBAG V1.2\nabc")),
                    Catch::Contains("rosbag fix"));
  CHECK_THROWS_WITH(open_bag(folder.write("a.mcap", "nothing of the kind")),
                    Catch::Contains("does not begin as a recording"));
  folder.write("drive/a.db3", db3_bytes());
  folder.write("drive/b.db3", db3_bytes());
  CHECK_THROWS_WITH(open_bag(folder / "drive"), Catch::Contains("ros2 bag reindex"));
  std::filesystem::remove(folder / "drive/b.db3");
  std::string other = metadata("5", "    - a.db3\n");
  other.replace(other.find("sqlite3"), 7, "my_store");
  folder.write("drive/metadata.yaml", other);
  CHECK_THROWS_WITH(open_bag(folder / "drive"), Catch::Contains("my_store"));
  folder.write("drive/metadata.yaml", metadata("5", "    - ../../etc/passwd\n"));
  CHECK_THROWS_WITH(open_bag(folder / "drive"), Catch::Contains("none of the files"));
  CHECK_FALSE(is_bag(folder.path()));
}

TEST_CASE("Metadata in flow style is read, and what is no YAML is refused with its line",
          "[bags][ros2]") {
  const TemporaryFolder folder;
  folder.write("drive/a.db3", db3_bytes());
  folder.write("drive/metadata.yaml",
               "rosbag2_bagfile_information: # as PyYAML writes it\n"
               "  {version: 5, storage_identifier: 'sqlite3', duration: {nanoseconds: 1000},\n"
               "   message_count: 5, relative_file_paths: [\"a.db3\"],\n"
               "   files: [{path: a.db3, message_count: 4}]}\n");
  const auto bag = open_bag(folder / "drive");
  CHECK(test::texts_of(*bag, "/pose") == std::vector<std::string>{"pose 0", "pose 1"});
  REQUIRE(bag->damage().size() == 1);
  CHECK_THAT(bag->damage()[0], Catch::Contains("a.db3 has 4 messages, but 5 can be read"));
  folder.write("drive/metadata.yaml", metadata("5", "    - {path: a.db3}\n"));
  CHECK_THROWS_WITH(open_bag(folder / "drive"),
                    Catch::Contains("metadata.yaml:14") && Catch::Contains("name of a file"));
  folder.write("drive/metadata.yaml", "a: 1\nb: [\n");
  CHECK_THROWS_WITH(open_bag(folder / "drive"),
                    Catch::Contains("metadata.yaml:3") && Catch::Contains("ros2 bag reindex"));
  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "[";
  folder.write("drive/metadata.yaml", deep);
  CHECK_THROWS_AS(open_bag(folder / "drive"), DataError);
}

}  // namespace
}  // namespace raymoval
