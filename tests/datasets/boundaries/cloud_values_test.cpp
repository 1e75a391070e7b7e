// SPDX-License-Identifier: MIT
// Values of clouds: each number type, each rounding and each count at its bound, worked out by
// hand.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// A header of x, y, z, each of this size and type.
std::string pcd_of(const std::string& size, const std::string& type, int points,
                   const std::string& data) {
  const std::string count = std::to_string(points);
  return "FIELDS x y z\nSIZE " + size + " " + size + " " + size + "\nTYPE " + type + " " + type +
         " " + type + "\nWIDTH " + count + "\nHEIGHT 1\nDATA " + data + "\n";
}

/// A compressed cloud of `points` points x y z as float32.
std::string compressed_pcd(int points, const std::string& stream) {
  return pcd_of("4", "F", points, "binary_compressed") +
         words({static_cast<std::uint32_t>(stream.size()), 12U * static_cast<unsigned>(points)}) +
         stream;
}

/// `bytes` zeros, at least 10, in as few bytes as LZF can: a control byte below 32 is followed by
/// that many bytes and one more; 0xE0, n and a zero repeat the last byte n + 9 times.
std::string packed_zeros(std::size_t bytes) {
  std::string stream(2, '\0');  // One literal zero.
  for (std::size_t left = bytes - 1; left > 0;) {
    // What remains for the last repetition must not be below its least length.
    std::size_t run = std::min<std::size_t>(left, 264);
    if (left > run && left - run < 9) run = left - 9;
    stream += '\xE0';
    stream += static_cast<char>(run - 9);
    stream += '\0';
    left -= run;
  }
  return stream;
}

template <class Value>
Eigen::Vector3f read_binary(const std::string& type, const std::vector<Value>& values) {
  const TemporaryFolder folder;
  const std::string size = std::to_string(sizeof(Value));
  return read_cloud(folder.write("a.pcd", pcd_of(size, type, 1, "binary") + bytes_of(values)))
      .points.at(0);
}

std::string cloud_error(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  const auto path = folder.write(name, content);
  return message_of<DataError>([&] { read_cloud(path); });
}

}  // namespace

TEST_CASE("each number type of a PCD file has its size and sign", "[cloud]") {
  // All bits set are -1 with a sign, and the largest number without one.
  CHECK(read_binary<std::int8_t>("I", {-1, 2, -128}) == Eigen::Vector3f(-1, 2, -128));
  CHECK(read_binary<std::uint8_t>("U", {255, 2, 128}) == Eigen::Vector3f(255, 2, 128));
  CHECK(read_binary<std::int16_t>("I", {-1, 300, -32768}) == Eigen::Vector3f(-1, 300, -32768));
  CHECK(read_binary<std::uint16_t>("U", {65535, 300, 32768}) == Eigen::Vector3f(65535, 300, 32768));
  CHECK(read_binary<std::int32_t>("I", {-1, 70000, -70000}) == Eigen::Vector3f(-1, 70000, -70000));
  CHECK(read_binary<std::uint32_t>("U", {0x80000000U, 70000, 1}) ==
        Eigen::Vector3f(0x1p31F, 70000, 1));
  CHECK(read_binary<std::int64_t>("I", {-1, 1LL << 40, -5}) == Eigen::Vector3f(-1, 0x1p40F, -5));
  CHECK(read_binary<std::uint64_t>("U", {1ULL << 63, 1ULL << 40, 5}) ==
        Eigen::Vector3f(0x1p63F, 0x1p40F, 5));
  CHECK(read_binary<float>("F", {-1.5F, 0.1F, 9}) == Eigen::Vector3f(-1.5F, 0.1F, 9));
  CHECK(read_binary<double>("F", {-1.5, 0.1, 9}) == Eigen::Vector3f(-1.5F, 0.1F, 9));
}

TEST_CASE("what is taken off coordinates is not taken off intensities", "[cloud]") {
  const TemporaryFolder folder;
  // An origin has three numbers; the memory behind it is not read.
  const struct {
    Eigen::Vector3d origin;
    double behind;
  } given{{1.0, -0.5, 0.125}, 100.0};
  const std::string head =
      "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 1\nHEIGHT 1\nDATA ";
  const std::string row = floats({1.5F, 2, 3, 7});
  // 17 literal bytes: LZF's control byte is the count minus one.
  for (const auto& path :
       {folder.write("a.pcd", head + "ascii\n1.5 2 3 7\n"),
        folder.write("b.pcd", head + "binary\n" + row),
        folder.write("c.pcd", head + "binary_compressed\n" + words({17, 16}) + "\x0F" + row),
        folder.write("d.bin", row)}) {
    CAPTURE(path);
    const Cloud cloud = read_cloud(path, given.origin);
    CHECK(cloud.points.at(0) == Eigen::Vector3f(0.5F, 2.5F, 2.875F));
    CHECK(cloud.intensity == std::vector<float>{7.0F});
  }
}

TEST_CASE("ASCII rows may have blank lines between them and no end of the last line", "[cloud]") {
  const TemporaryFolder folder;
  const std::string head = pcd_of("4", "F", 2, "ascii");
  for (const std::string body :
       {"1 2 3\n4 5 6", "\n1 2 3\n \t\r\n4 5 6\n\n\t\n", "1 2 3\r\n4 5 6\r"}) {
    const Cloud cloud = read_cloud(folder.write("a.pcd", head + body));
    CHECK(cloud.points == std::vector<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}});
    CHECK(cloud.intensity.empty());
  }
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  check_says(cloud_error("a.ply", ply + "4 five 6\n"), {"line 9, column 3", "'five'"});
}

TEST_CASE("a compressed cloud may be as small as LZF can make it", "[cloud]") {
  const std::string stream = packed_zeros(24000);
  REQUIRE(stream.size() * 87 < 24000);  // 88 is the limit, and what is above it is damaged.
  const TemporaryFolder folder;
  const Cloud cloud = read_cloud(folder.write("zeros.pcd", compressed_pcd(2000, stream)));
  REQUIRE(cloud.points.size() == 2000);
  CHECK(cloud.points.front() == Eigen::Vector3f::Zero());
  CHECK(cloud.points.back() == Eigen::Vector3f::Zero());
}

TEST_CASE("a block that announces more than LZF can give is not decoded at all", "[cloud]") {
  // A literal megabyte would be written far beyond the buffer.
  std::string stream;
  for (int i = 0; i < 1 << 15; ++i) stream += "\x1F" + std::string(32, 'a');
  check_says(cloud_error("a.pcd", compressed_pcd(357913940, stream)), {"damaged"});
}

TEST_CASE("an unknown ending of a cloud's name is told with those there are", "[cloud]") {
  check_says(message_of<UsageError>([] { read_cloud("a.abc"); }),
             {"a.abc: '.abc' is not a known cloud format", ".pcd, .ply, .bin, .npy"});
  check_says(message_of<UsageError>([] { read_cloud("a.laz"); }), {"a.laz: LAZ", "pdal translate"});
}
