// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/bags/bag_formats.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/bags/messages/pose_messages.h"
#include "tests/datasets/bags/recordings.h"
#include "tests/datasets/bags/ros1_writer.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {
namespace {

const std::vector<std::string> kWrittenByRos = {"rosbag_none", "rosbag_bz2", "rosbag_lz4"};

/// The bytes of a bag that ROS's own rosbag wrote, see make_ros1_bags.py.
std::string written_by_ros(const std::string& name) {
  return read_text(recording("bag_ros1/" + name + ".bag"));
}

/// All messages of a bag: topic, time, bytes.
using AllMessages = std::vector<std::tuple<std::string, Nanoseconds, std::string>>;
AllMessages all_messages(const Bag& bag) {
  AllMessages all;
  for_each_message(bag, [&](std::size_t topic, std::size_t i) {
    all.emplace_back(bag.topics()[topic].name, bag.recorded(topic, i), bag.message(topic, i));
  });
  std::sort(all.begin(), all.end());
  return all;
}

/// A bag of `chunks` chunks, each with `messages` messages of 20 bytes on /a and /b in turn.
std::filesystem::path write_bag(const TemporaryFolder& folder, int chunks, int messages,
                                Ros1Compression compression = Ros1Compression::kNone) {
  Ros1Writer writer(compression);
  for (int chunk = 0; chunk < chunks; ++chunk) {
    for (int i = 0; i < messages; ++i) {
      const int number = chunk * messages + i;
      writer.message(static_cast<std::uint32_t>(i % 2), i % 2 == 0 ? "/a" : "/b", "std_msgs/String",
                     "m", 1'000'000'000LL * number,
                     std::string(20, static_cast<char>('a' + number % 26)));
    }
    writer.end_chunk();
  }
  return folder.write("made.bag", writer.finish());
}

TEST_CASE("Bags that ROS wrote are read with every compression", "[bags]") {
  const TemporaryFolder folder;
  for (const std::string& name : kWrittenByRos) {
    const auto bag = open_ros1(folder.write(name + ".bag", written_by_ros(name)));
    CHECK(bag->damage().empty());
    REQUIRE(bag->topics().size() == 2);
    const std::size_t points = topic_named(*bag, "/points"), odometry = topic_named(*bag, "/odom");
    CHECK(bag->topics()[points].type == "sensor_msgs/PointCloud2");
    CHECK(bag->topics()[points].encoding == MessageEncoding::kRos1);
    REQUIRE(bag->topics()[points].messages == 3);
    REQUIRE(bag->topics()[odometry].messages == 2);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(bag->recorded(points, i) ==
            1'000'100'000'000 + 100'000'000 * static_cast<Nanoseconds>(i));
      const std::string message = bag->message(points, i);
      const PointRecords cloud =
          read_points(message, bag->topics()[points].type, MessageEncoding::kRos1, name);
      REQUIRE(cloud.size() == 2);
      CHECK(cloud.value(0, *cloud.layout.find({"x"})) == static_cast<double>(i + 1));
      CHECK(cloud.value(1, *cloud.layout.find({"ring"})) == 8);
      CHECK(bag->message_head(points, i, 10) == message.substr(0, 10));
    }
    const auto poses =
        read_poses(bag->message(odometry, 1), "nav_msgs/Odometry", MessageEncoding::kRos1, name);
    CHECK(poses.at(0).position.x() == 1);
    CHECK(poses.at(0).child == "lidar");
  }
}

TEST_CASE("A bag cut at any byte is read as far as it goes, and says so", "[bags]") {
  const TemporaryFolder folder;
  for (const std::string& name : kWrittenByRos) {
    const std::string bytes = written_by_ros(name);
    const AllMessages whole = all_messages(*open_ros1(folder.write("whole.bag", bytes)));
    std::uint64_t before = 0;
    for (std::size_t size = 0; size < bytes.size(); size += size < 4000 ? 497 : 7) {
      const auto path = folder.write("cut.bag", bytes.substr(0, size));
      if (size < 90) {
        CHECK_THROWS_AS(open_ros1(path), DataError);
        continue;
      }
      const auto bag = open_ros1(path);
      REQUIRE_FALSE(bag->damage().empty());
      CHECK_THAT(bag->damage()[0], Catch::Contains("cut.bag"));
      const AllMessages cut = all_messages(*bag);
      REQUIRE(std::includes(whole.begin(), whole.end(), cut.begin(), cut.end()));
      REQUIRE(cut.size() >= before);
      before = cut.size();
    }
    CHECK(before == whole.size());
  }
}

TEST_CASE("A bag that was never closed is read whole", "[bags]") {
  const TemporaryFolder folder;
  for (const std::string& name : kWrittenByRos) {
    std::string bytes = written_by_ros(name);
    const AllMessages whole = all_messages(*open_ros1(folder.write("whole.bag", bytes)));
    const std::size_t place = bytes.find("index_pos=") + 10;
    bytes.replace(place, 8, std::string(8, '\0'));
    const auto bag = open_ros1(folder.write("open.bag", bytes));
    CHECK(all_messages(*bag) == whole);
    check_says(bag->damage().at(0), {"never closed", "rosbag reindex"});
    // So is the file that rosbag leaves where it was ended.
    CHECK(open_bag(folder.write("a.bag.active", bytes))->damage().size() == 1);
    CHECK(is_bag(folder / "a.bag.active"));
  }
}

TEST_CASE("An index that does not fit its chunk is not believed", "[bags]") {
  const TemporaryFolder folder;
  const std::string bytes = read_text(write_bag(folder, 2, 6));
  const AllMessages whole = all_messages(*open_ros1(folder / "made.bag"));
  REQUIRE(whole.size() == 12);
  // Each record of an index behind a chunk, one at a time.
  for (std::size_t at = bytes.find("count="); at != std::string::npos;
       at = bytes.find("count=", at + 1)) {
    std::string wrong = bytes;
    wrong[at + 6] = static_cast<char>(wrong[at + 6] + 1);
    const auto bag = open_ros1(folder.write("wrong.bag", wrong));
    CHECK(all_messages(*bag) == whole);
  }
}

TEST_CASE("A message that the index places wrong is an error and no other message", "[bags]") {
  const TemporaryFolder folder;
  std::string bytes = read_text(write_bag(folder, 1, 2));
  // The two entries of the index differ only in their times and places: the first gets the place of
  // the second.
  const std::size_t first = bytes.find(std::string("ver=\1\0\0\0", 8)) + 12;
  const std::size_t second = bytes.find(std::string("ver=\1\0\0\0", 8), first) + 12;
  bytes.replace(first + 8, 4, bytes.substr(second + 8, 4));
  const auto bag = open_ros1(folder.write("wrong.bag", bytes));
  check_says(message_of<DataError>([&] { (void)bag->message(topic_named(*bag, "/a"), 0); }),
             {"wrong.bag", "another topic", "rosbag reindex"});
}

TEST_CASE("Topics of one name with another type are kept apart", "[bags]") {
  const TemporaryFolder folder;
  Ros1Writer writer(Ros1Compression::kBz2);
  writer.message(0, "/a", "std_msgs/String", "one", 2, "first");
  writer.message(1, "/a", "std_msgs/String", "two", 3, "second");
  writer.message(2, "/a", "std_msgs/String", "one", 1, "third");
  const auto bag = open_ros1(folder.write("two.bag", writer.finish()));
  REQUIRE(bag->topics().size() == 2);
  CHECK(bag->topics()[0].messages == 2);
  CHECK(bag->message(0, 0) == "third");  // In the order of their times.
  CHECK(bag->message(0, 1) == "first");
  CHECK(bag->message(1, 0) == "second");
}

TEST_CASE("A file that is no bag of version 2.0 is refused", "[bags]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& bytes) {
    return message_of<DataError>([&] { (void)open_ros1(folder.write("x.bag", bytes)); });
  };
  check_says(refused("#ROSBAG V1.2\n"), {"x.bag", "version 2.0"});
  check_says(refused(""), {"x.bag"});
  std::string encrypted = written_by_ros("rosbag_none");
  // rosbag writes the name of an encryptor into the header; here in place of a count.
  const std::size_t at = encrypted.find("conn_count=");
  encrypted.replace(at, 15, "encryptor=aescb");
  check_says(refused(encrypted), {"encrypted", "rosbag decrypt"});
}

TEST_CASE("Lengths that lie ask for no memory", "[bags]") {
  const TemporaryFolder folder;
  const std::string bytes = read_text(write_bag(folder, 1, 2, Ros1Compression::kLz4));
  const auto at_chunk = [&](const char* field) { return bytes.find(field, 4117) + 5; };
  std::string size = bytes;
  size.replace(at_chunk("size="), 4, "\xFF\xFF\xFF\x7F");
  CHECK_THAT(open_ros1(folder.write("x.bag", size))->damage().at(0),
             Catch::Contains("beyond the limit of 1 GiB"));
  for (std::size_t place = 4117; place + 4 < bytes.size(); ++place) {
    std::string wrong = bytes;
    wrong.replace(place, 4, "\xFF\xFF\xFF\xFF");
    try {
      const auto bag = open_ros1(folder.write("x.bag", wrong));
      (void)all_messages(*bag);
    } catch (const DataError& error) {
      CHECK_THAT(error.what(), Catch::Contains("x.bag"));
    }
  }
}

}  // namespace
}  // namespace raymoval::test
