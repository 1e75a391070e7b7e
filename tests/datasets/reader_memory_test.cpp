// SPDX-License-Identifier: MIT
// Readers need no more memory than a stated number of times the size of the file, for any header.
// The numbers are those of SECURITY.md.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zstd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/bags/bag.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/poses.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"
#include "tests/datasets/bags/mcap_records.h"
#include "tests/datasets/bags/message_bytes.h"
#include "tests/datasets/bags/ros1_writer.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;

namespace {

constexpr std::size_t kMegabyte = 1 << 20;

std::size_t address_space() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Whether `read` gets along with `bytes` more than the program has already. It may refuse its
/// file.
bool suffices(std::size_t bytes, const std::function<void()>& read) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const rlim_t most = address_space() + bytes;
    const rlimit limit{most, most};
    if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(3);
    try {
      read();
    } catch (const std::bad_alloc&) {
      ::_exit(1);
    } catch (const Error&) {
      ::_exit(0);
    }
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  REQUIRE(WEXITSTATUS(status) <= 1);
  return WEXITSTATUS(status) == 0;
}

/// Sanitizers reserve very much address space.
bool can_be_limited() {
  return address_space() < (std::size_t{1} << 40);
}

/// @param times how much memory the reader may take, in sizes of the file
void check_memory(const std::filesystem::path& file, double times,
                  const std::function<void()>& read) {
  constexpr std::size_t kForItself = 2 * kMegabyte;
  if (!can_be_limited()) return;
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  INFO(file.filename() << " of " << size << " bytes");
  CHECK(suffices(static_cast<std::size_t>(times * size) + kForItself, read));
}

std::string repeated(const std::string& text, std::size_t bytes) {
  std::string whole;
  while (whole.size() + text.size() <= bytes) whole += text;
  return whole;
}

std::string pcd(const std::string& size, const std::string& type, std::size_t points,
                const std::string& data) {
  const std::string count = std::to_string(points);
  return "FIELDS x y z\nSIZE " + size + "\nTYPE " + type + "\nCOUNT 1 1 1\nWIDTH " + count +
         "\nHEIGHT 1\nPOINTS " + count + "\nDATA " + data + "\n";
}

/// Zeros in the fewest bytes: three literal zeros, and references of three bytes to 264 zeros.
std::string lzf_bomb(std::size_t references) {
  const auto unpacked = static_cast<std::uint32_t>(3 + 264 * references);
  std::string packed("\x02\0\0\0", 4);
  for (std::size_t i = 0; i < references; ++i) packed += std::string("\xE0\xFF\x00", 3);
  std::string sizes;
  for (const auto size : {static_cast<std::uint32_t>(packed.size()), unpacked}) {
    sizes.append(reinterpret_cast<const char*>(&size), sizeof size);
  }
  return sizes + packed;
}

/// A message with `points` points of `step` bytes each, that all lie at (1, 1, 1).
std::string cloud_of_bytes(std::uint32_t points, std::uint32_t step) {
  test::CloudHead head;
  head.width = points;
  head.point_step = step;
  head.fields = {{"x", 0, 2}, {"y", step / 3, 2}, {"z", 2 * (step / 3), 2}};
  return test::cloud_message(test::MessageBytes(MessageEncoding::kRos1), head,
                             std::string(points * step, '\1'));
}

/// A MCAP file with one chunk, which unpacks to 1,000 times its size: that message.
std::string mcap_bomb(std::uint32_t points, std::uint32_t step) {
  using namespace test::mcap;
  const std::string records = record(McapOp::kSchema, schema(1, "sensor_msgs/PointCloud2")) +
                              record(McapOp::kChannel, channel(1, 1, "/points", "ros1")) +
                              record(McapOp::kMessage, message(1, 5, cloud_of_bytes(points, step)));
  std::string packed(ZSTD_compressBound(records.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 1));
  const std::size_t filling = records.size() / 1000 - packed.size() - 8;  // A frame to skip.
  packed += number(std::uint32_t{0x184D2A50}) + number(static_cast<std::uint32_t>(filling)) +
            std::string(filling, '\0');
  return mcap_of({{McapOp::kChunk, chunk("zstd", records.size(), 0, packed)},
                  {McapOp::kDataEnd, std::string(4, '\0')}});
}

/// The same as a ROS 1 bag, whose chunk unpacks to 250 times its size.
std::string ros1_bomb(std::uint32_t points, std::uint32_t step) {
  test::Ros1Writer bag(Ros1Compression::kLz4);
  bag.message(0, "/points", "sensor_msgs/PointCloud2", "", 5, cloud_of_bytes(points, step));
  return bag.finish();
}

/// The points of the first message.
std::size_t read_recording(const std::filesystem::path& path) {
  const auto bag = open_bag(path);
  const BagTopic& topic = bag->topics().front();
  return read_point_positions(bag->message(0, 0), topic.type, topic.encoding,
                              Eigen::Vector3d::Zero(), path.string())
      .points.size();
}

}  // namespace

TEST_CASE("a limit of memory is noticed") {
  if (!can_be_limited()) return;
  const auto hungry = [] {
    std::string text(64 * kMegabyte, 'x');
    const volatile char* seen = text.data();  // Else a compiler may leave the text out.
    if (seen[text.size() / 2] == 'y') throw DataError("never");
  };
  CHECK_FALSE(suffices(32 * kMegabyte, hungry));
  CHECK(suffices(96 * kMegabyte, hungry));
}

TEST_CASE("readers of scans need a bounded number of times their file") {
  const test::TemporaryFolder folder;
  const auto check_cloud = [&](const std::string& name, double times, const std::string& content) {
    const auto file = folder.write(name, content);
    check_memory(file, times, [&] { (void)read_cloud(file); });
  };
  check_cloud("zeros.bin", 3, std::string(kMegabyte, '\0'));
  const std::string body(kMegabyte, '\0');
  check_cloud("bytes.pcd", 6, pcd("1 1 1", "I I I", body.size() / 3, "binary") + body);
  check_cloud("none.pcd", 6, pcd("1 1 1", "I I I", 2000000000, "binary") + body);
  const std::string rows = repeated("0 0 0\n", kMegabyte);
  check_cloud("rows.pcd", 6, pcd("4 4 4", "F F F", rows.size() / 6, "ascii") + rows);
  check_cloud("few.pcd", 6, pcd("4 4 4", "F F F", 2000000000, "ascii") + rows);
  check_cloud("blank.pcd", 6,
              pcd("4 4 4", "F F F", 2000000000, "ascii") + std::string(kMegabyte, '\n'));
  const std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string properties =
      "\nproperty char x\nproperty char y\nproperty char z\nend_header\n";
  check_cloud("bytes.ply", 6, ply + std::to_string(body.size() / 3) + properties + body);
  check_cloud("none.ply", 6, ply + "2000000000" + properties + body);
  constexpr std::size_t kReferences = 50000;
  constexpr std::size_t kPoints = 1 + 88 * kReferences;
  const auto packed = lzf_bomb(kReferences);
  const auto bomb =
      folder.write("bomb.pcd", pcd("1 1 1", "I I I", kPoints, "binary_compressed") + packed);
  CHECK(read_cloud(bomb).points.size() == kPoints);  // It decompresses.
  check_memory(bomb, 450, [&] { (void)read_cloud(bomb); });
  check_cloud("lies.pcd", 450, pcd("1 1 1", "I I I", kPoints + 1, "binary_compressed") + packed);
  check_cloud("far.pcd", 450, pcd("1 1 1", "I I I", 2000000000, "binary_compressed") + packed);
}

TEST_CASE("readers of recordings need a bounded number of times what their chunks unpack to") {
  const test::TemporaryFolder folder;
  constexpr std::uint32_t kPoints = 5'000'000, kMany = 20'000'000;
  const auto check = [&](const std::string& name, const std::string& content, double unpacked) {
    const auto file = folder.write(name, content);
    check_memory(file, 8.0 * unpacked / static_cast<double>(content.size()),
                 [&] { (void)read_recording(file); });
    return file;
  };
  CHECK(read_recording(check("bomb.mcap", mcap_bomb(kPoints, 3), 3.0 * kPoints)) == kPoints);
  CHECK(read_recording(check("bomb.bag", ros1_bomb(kPoints, 3), 3.0 * kPoints)) == kPoints);
  // Points that share their bytes, and more than a scan has, are refused.
  for (const auto& file : {check("shared.mcap", mcap_bomb(3 * kPoints, 1), 3.0 * kPoints),
                           check("map.mcap", mcap_bomb(kMany, 3), 3.0 * kMany)}) {
    CHECK_THROWS_AS(read_recording(file), DataError);
  }
}
