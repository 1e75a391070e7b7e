// SPDX-License-Identifier: MIT
// Sizes in compressed PCD files, with streams made by hand. LZF: a control byte below 32 is
// followed by that many bytes and one more; 0xE0, n and a zero repeat the last byte n + 9 times.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using raymoval::test::TemporaryFolder;

namespace {

/// A compressed cloud of `points` points x y z as float32.
std::string cloud_file(int points, const std::string& stream) {
  const auto word = [](std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&narrow), sizeof narrow);
  };
  return "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nPOINTS " + std::to_string(points) + "\nDATA binary_compressed\n" +
         word(stream.size()) + word(static_cast<std::size_t>(points) * 12) + stream;
}

/// `bytes` zeros, at least 10, in as few bytes as LZF can.
std::string packed_zeros(std::size_t bytes) {
  std::string stream(2, '\0');  // One zero as it is.
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

}  // namespace

TEST_CASE("a compressed cloud may be as small as LZF can make it", "[cloud]") {
  const TemporaryFolder folder;
  const std::string stream = packed_zeros(24000);
  REQUIRE(stream.size() * 87 < 24000);  // 88 is the limit, and what is above it is damaged.
  const Cloud cloud = read_cloud(folder.write("zeros.pcd", cloud_file(2000, stream)));
  REQUIRE(cloud.points.size() == 2000);
  CHECK(cloud.points.front() == Eigen::Vector3f::Zero());
  CHECK(cloud.points.back() == Eigen::Vector3f::Zero());
}

TEST_CASE("a compressed cloud that holds fewer bytes than it announces is damaged", "[cloud]") {
  const TemporaryFolder folder;
  // Two points take 24 bytes. The stream decodes without a fault, to 23 or to 12.
  for (const int bytes : {23, 12}) {
    const std::string stream = static_cast<char>(bytes - 1) + std::string(std::size_t(bytes), 'a');
    CHECK_THROWS_WITH(read_cloud(folder.write("short.pcd", cloud_file(2, stream))),
                      Catch::Contains("damaged"));
  }
  const std::string whole = std::string("\x17") + std::string(24, 'a');
  CHECK(read_cloud(folder.write("whole.pcd", cloud_file(2, whole))).points.size() == 2);
  // And one that would give more.
  const std::string longer = std::string("\x18") + std::string(25, 'a');
  CHECK_THROWS_WITH(read_cloud(folder.write("longer.pcd", cloud_file(2, longer))),
                    Catch::Contains("damaged"));
}

TEST_CASE("a compressed block of exactly the rest of the file is whole", "[cloud]") {
  const TemporaryFolder folder;
  const std::string whole = cloud_file(2, std::string("\x17") + std::string(24, 'a'));
  CHECK(read_cloud(folder.write("whole.pcd", whole)).points.size() == 2);
  CHECK_THROWS_WITH(read_cloud(folder.write("cut.pcd", whole.substr(0, whole.size() - 1))),
                    Catch::Contains("truncated"));
}
