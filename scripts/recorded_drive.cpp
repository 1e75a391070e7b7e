// SPDX-License-Identifier: MIT
#include "scripts/recorded_drive.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "datasets/bags/chunks/pack.h"
#include "datasets/bags/mcap/mcap_writer.h"
#include "datasets/bags/ros1/ros1_writer.h"
#include "datasets/bags/ros2/sqlite.h"
#include "datasets/clouds/record_file.h"
#include "tests/datasets/bags/message_bytes.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;
using test::CloudHead;
using test::MessageBytes;

/// A driver writes a chunk when it has this many bytes: rosbag's and rosbag2's default.
constexpr std::size_t kChunkBytes = 768 * 1024;
constexpr std::uint32_t kFirstSecond = 1'600'000'000;

/// The sensor's place on its way of 40 m, and back; where it is the same, the scans are, too.
std::size_t metres_at(std::size_t scan) {
  constexpr std::size_t kWay = 40;
  const std::size_t phase = scan % (2 * kWay);
  return phase < kWay ? phase : 2 * kWay - phase;
}

/// A velodyne driver's point: x y z intensity as float32, ring as uint16, time as float32.
PointRecords scan_of(const Drive& drive, std::size_t scan) {
  constexpr std::size_t kRings = 32;
  PointRecords points;
  for (const char* name : {"x", "y", "z", "intensity"}) points.layout.add(name, 'F', 4);
  points.layout.add("ring", 'U', 2);
  points.layout.add("time", 'F', 4);
  points.bytes.resize(drive.points * points.layout.row_bytes);
  points.width = drive.points;
  std::minstd_rand random(static_cast<unsigned>(metres_at(scan) + 1));
  std::uniform_real_distribution<float> noise(-0.02F, 0.02F);
  const auto columns = static_cast<float>(drive.points) / kRings;
  for (std::size_t i = 0; i < drive.points; ++i) {
    const std::size_t ring = i % kRings;
    const float turn = static_cast<float>(i / kRings) / columns * 6.2831853F;
    const float rise = -0.4F + 0.02F * static_cast<float>(ring);
    const float range = (rise < -0.02F ? -1.8F / rise : 40.0F) + noise(random);
    const std::array<float, 4> place = {range * std::cos(turn), range * std::sin(turn),
                                        range * rise, std::floor(40.0F + 1000.0F * noise(random))};
    const auto ring_number = static_cast<std::uint16_t>(ring);
    const float time = turn / 62.831853F;
    std::byte* row = points.row(i);
    std::memcpy(row, place.data(), 16);
    std::memcpy(row + 16, &ring_number, 2);
    std::memcpy(row + 18, &time, 4);
  }
  return points;
}

Nanoseconds stamp_of(std::size_t scan) {
  return (Nanoseconds{kFirstSecond} * 10 + static_cast<Nanoseconds>(scan)) * 100'000'000;
}

std::string cloud_bytes(MessageEncoding encoding, const Drive& drive, std::size_t scan) {
  const PointRecords points = scan_of(drive, scan);
  CloudHead head;
  head.seconds = static_cast<std::uint32_t>(stamp_of(scan) / 1'000'000'000);
  head.nanoseconds = static_cast<std::uint32_t>(stamp_of(scan) % 1'000'000'000);
  head.width = static_cast<std::uint32_t>(drive.points);
  head.fields = {{"x", 0, 7},          {"y", 4, 7},     {"z", 8, 7},
                 {"intensity", 12, 7}, {"ring", 16, 4}, {"time", 18, 7}};
  head.point_step = static_cast<std::uint32_t>(points.layout.row_bytes);
  head.row_step = head.point_step * head.width;
  return cloud_message(MessageBytes(encoding), head,
                       {reinterpret_cast<const char*>(points.bytes.data()), points.bytes.size()});
}

std::string pose_bytes(MessageEncoding encoding, std::size_t scan) {
  return MessageBytes(encoding)
      .header(static_cast<std::uint32_t>(stamp_of(scan) / 1'000'000'000),
              static_cast<std::uint32_t>(stamp_of(scan) % 1'000'000'000), "map")
      .motion({static_cast<double>(metres_at(scan)), 0, 0, 0, 0, 0, 1})
      .bytes();
}

/// A topic of the recordings, and how its messages are made.
struct Topic {
  std::uint16_t id;
  std::string name, type;
  std::function<std::string(MessageEncoding, std::size_t)> message;
};
std::vector<Topic> topics_of(const Drive& drive) {
  return {{1, "/pose", "PoseStamped", pose_bytes},
          {2, "/points", "PointCloud2", [drive](MessageEncoding encoding, std::size_t scan) {
             return cloud_bytes(encoding, drive, scan);
           }}};
}
std::string package_of(const Topic& topic) {
  return topic.type == "PoseStamped" ? "geometry_msgs" : "sensor_msgs";
}

void write_ros1(const Drive& drive, const fs::path& path, Ros1Compression compression) {
  const auto field = [](const std::string& text) {
    std::string bytes;
    put_text(bytes, text);
    return bytes;
  };
  FileWriter file(path);
  Ros1Writer writer(file);
  writer.begin_chunk(compression);
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    for (const Topic& topic : topics_of(drive)) {
      const std::string type = package_of(topic) + "/" + topic.type;
      const Ros1Connection connection{
          topic.id, topic.name, type, "*",
          field("topic=" + topic.name) + field("type=" + type) + field("md5sum=*")};
      writer.message(connection, stamp_of(scan), topic.message(MessageEncoding::kRos1, scan));
      if (writer.chunk_size() < kChunkBytes) continue;
      writer.end_chunk();
      writer.begin_chunk(compression);
    }
  }
  writer.finish();
  file.commit();
}

void write_mcap(const Drive& drive, const fs::path& path, const std::string& compression) {
  const std::vector<Topic> topics = topics_of(drive);
  FileWriter file(path);
  McapWriter writer(file);
  std::string head;
  put_text(head, "ros2");
  put_text(head, "bag_reading");
  writer.record(McapOp::kHeader, head);
  for (const Topic& topic : topics) {
    std::string schema, channel;
    put_u16(schema, topic.id);
    for (const std::string& text :
         {package_of(topic) + "/msg/" + topic.type, std::string("ros2msg"), std::string()}) {
      put_text(schema, text);
    }
    writer.record(McapOp::kSchema, schema);
    put_u16(channel, topic.id);
    put_u16(channel, topic.id);
    for (const std::string& text : {topic.name, std::string("cdr"), std::string()}) {
      put_text(channel, text);
    }
    writer.record(McapOp::kChannel, channel);
  }
  writer.begin_chunk(compression);
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    for (const Topic& topic : topics) {
      std::string message;
      put_u16(message, topic.id);
      put_u32(message, static_cast<std::uint32_t>(scan));
      put_u64(message, static_cast<std::uint64_t>(stamp_of(scan)));
      put_u64(message, static_cast<std::uint64_t>(stamp_of(scan)));
      writer.record(McapOp::kMessage, message + topic.message(MessageEncoding::kCdr, scan));
      if (writer.chunk().size() < kChunkBytes) continue;
      writer.end_chunk();
      writer.begin_chunk(compression);
    }
  }
  writer.end_chunk();
  writer.finish();
  file.commit();
}

/// A folder as ROS 2 records it, with one database.
void write_db3(const Drive& drive, const fs::path& folder, bool packed) {
  fs::create_directory(folder);
  write_atomically(folder / "metadata.yaml",
                   fmt::format("rosbag2_bagfile_information:\n  version: 4\n"
                               "  storage_identifier: sqlite3\n  message_count: {}\n"
                               "  relative_file_paths:\n    - drive.db3\n"
                               "  compression_format: \"{}\"\n  compression_mode: \"{}\"\n",
                               2 * drive.scans, packed ? "zstd" : "", packed ? "MESSAGE" : ""));
  write_atomically(folder / "drive.db3", "");
  const SqliteDatabase database = SqliteDatabase::to_write(folder / "drive.db3");
  database.run("BEGIN");
  database.run(
      "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT "
      "NULL,serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL)");
  database.run(
      "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp "
      "INTEGER NOT NULL, data BLOB NOT NULL)");
  database.run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  for (const Topic& topic : topics_of(drive)) {
    database.run(fmt::format("INSERT INTO topics VALUES({},'{}','{}/msg/{}','cdr','')", topic.id,
                             topic.name, package_of(topic), topic.type));
  }
  SqliteStatement insert(database, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)");
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    for (const Topic& topic : topics_of(drive)) {
      const std::string message = topic.message(MessageEncoding::kCdr, scan);
      insert.bind(1, std::int64_t{topic.id});
      insert.bind(2, stamp_of(scan));
      insert.bind(3, packed ? pack_zstd(message) : message);
      insert.run();
    }
  }
  database.run("COMMIT");
}

/// Files of the form that `ending` says, with poses: 000000.pcd; .bin as SemanticKITTI has them.
void write_files(const Drive& drive, const fs::path& folder, const std::string& ending) {
  const bool is_kitti = ending == ".bin";
  const fs::path clouds = is_kitti ? folder / "velodyne" : folder;
  fs::create_directories(clouds);
  std::string poses;
  for (std::size_t scan = 0; scan < drive.scans; ++scan) {
    PointRecords points = scan_of(drive, scan);
    if (is_kitti) {
      PointRecords plain;
      for (std::size_t f = 0; f < 4; ++f) plain.layout.add(points.layout.fields[f].name, 'F', 4);
      plain.layout.unnamed = true;
      plain.width = points.size();
      for (std::size_t i = 0; i < points.size(); ++i) {
        plain.bytes.insert(plain.bytes.end(), points.row(i), points.row(i) + 16);
      }
      points = std::move(plain);
    }
    PointRecordWriter file(clouds / fmt::format("{:06}{}", scan, ending));
    file.start(points.layout);
    file.add(points);
    file.finish();
    file.commit();
    poses += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", metres_at(scan));
  }
  write_atomically(folder / "poses.txt", poses);
  if (is_kitti) write_atomically(folder / "sequence.json", R"({"poses_are_lidar": true})");
}

}  // namespace

std::vector<DriveForm> drive_forms() {
  const auto ros1 = [](Ros1Compression how) {
    return [how](const Drive& drive, const fs::path& path) { write_ros1(drive, path, how); };
  };
  const auto mcap = [](const std::string& how) {
    return [how](const Drive& drive, const fs::path& path) { write_mcap(drive, path, how); };
  };
  const auto db3 = [](bool packed) {
    return [packed](const Drive& drive, const fs::path& path) { write_db3(drive, path, packed); };
  };
  const auto files = [](const std::string& ending) {
    return [ending](const Drive& drive, const fs::path& path) { write_files(drive, path, ending); };
  };
  return {{"folder of .bin (x y z intensity)", "bin", files(".bin")},
          {"folder of .pcd, binary", "pcd", files(".pcd")},
          {"ROS 1 bag", "ros1.bag", ros1(Ros1Compression::kNone)},
          {"ROS 1 bag, lz4", "ros1_lz4.bag", ros1(Ros1Compression::kLz4)},
          {"ROS 2 folder, .db3", "db3", db3(false)},
          {"ROS 2 folder, .db3, zstd by message", "db3_zstd", db3(true)},
          {"MCAP", "none.mcap", mcap("")},
          {"MCAP, lz4", "lz4.mcap", mcap("lz4")},
          {"MCAP, zstd", "zstd.mcap", mcap("zstd")}};
}

}  // namespace raymoval
