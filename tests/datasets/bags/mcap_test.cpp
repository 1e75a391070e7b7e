// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/bags/bag_formats.h"
#include "tests/datasets/bags/mcap_records.h"
#include "tests/datasets/bags/recordings.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval {
namespace {

using namespace test::mcap;
using test::TemporaryFolder;

TEST_CASE("MCAP that another program wrote is read, whatever it leaves out", "[bags][mcap]") {
  const std::string name = GENERATE("chunks", "zstd", "lz4", "no_chunks", "no_statistics",
                                    "no_schemas", "no_message_index", "bare");
  CAPTURE(name);
  test::check_content(*open_bag(test::recording("bag_mcap/" + name + ".mcap")));
}

TEST_CASE("MCAP that is cut at any byte is read as far as it goes, and says so", "[bags][mcap]") {
  const std::string name = GENERATE("chunks", "zstd", "no_chunks");
  const std::string whole = test::file_bytes(test::recording("bag_mcap/" + name + ".mcap"));
  const TemporaryFolder folder;
  // The file gets shorter and shorter, which is quicker than to write it again.
  const auto path = folder.write("cut.mcap", whole);
  std::uint64_t before = 5;
  for (std::size_t size = whole.size(); size-- > 0;) {
    CAPTURE(name, size);
    std::filesystem::resize_file(path, size);
    const std::uint64_t count = test::read_damaged(path);
    CHECK(count <= before);  // Fewer bytes never give more messages.
    before = count;
    if (size == whole.size() - 1) CHECK(count == 5);
  }
  CHECK(before == 0);
}

TEST_CASE("A false byte in a MCAP file never gives a message that was not published",
          "[bags][mcap]") {
  const std::string whole = test::file_bytes(test::recording("bag_mcap/chunks.mcap"));
  const TemporaryFolder folder;
  for (std::size_t at = 0; at < whole.size(); at += 11) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    const auto path = folder.write("damaged_" + std::to_string(at) + ".mcap", damaged);
    test::may_refuse([&] {
      const auto bag = open_bag(path);
      test::for_each_message(*bag, [&](std::size_t topic, std::size_t i) {
        const std::string text = bag->message(topic, i);
        CAPTURE(at);
        CHECK((text.substr(4).starts_with("po") || text.empty()));
      });
    });
  }
}

TEST_CASE("A chunk that claims more than it can hold is refused before memory is asked for",
          "[bags][mcap]") {
  const TemporaryFolder folder;
  const auto damage = [&](const std::string& content) {
    const auto path =
        folder.write("claims.mcap", mcap_of({{McapOp::kChannel, channel(1, 0, "/t", "cdr")},
                                             {McapOp::kChunk, content},
                                             {McapOp::kMessage, message(1, 4, "behind")},
                                             {McapOp::kDataEnd, std::string(4, '\0')}}));
    return open_mcap(path)->damage().at(0);
  };
  CHECK_THAT(damage(chunk("zstd", 1U << 29U, 0, "abc")), Catch::Contains("1,000 times"));
  CHECK_THAT(damage(chunk("lz4", 100, 0, "abc")), Catch::Contains("lz4"));
  CHECK_THAT(damage(chunk("snappy", 3, 0, "abc")), Catch::Contains("mcap compress"));
  CHECK_THAT(damage(chunk("", 99, 0, "abc")), Catch::Contains("99"));
  CHECK_THAT(damage(chunk("", 3, 77, "abc")), Catch::Contains("checksum"));
}

TEST_CASE("Chunks are not unpacked again for each of their messages", "[bags]") {
  ChunkStore store(10);
  int unpacked = 0;
  const auto six = [&] {
    ++unpacked;
    return std::string("123456");
  };
  CHECK(*store.get(1, six) == "123456");
  store.get(1, six);
  CHECK(unpacked == 1);
  store.get(2, six);  // Both together have more than 10 bytes.
  store.get(2, six);
  CHECK(unpacked == 2);
  store.get(1, six);
  CHECK(unpacked == 3);
  CHECK_THROWS_AS(store.get(3, []() -> std::string { throw DataError("damaged"); }), DataError);
  CHECK(*store.get(3, six) == "123456");
}

}  // namespace
}  // namespace raymoval
