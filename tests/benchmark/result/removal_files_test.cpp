// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/removal_files.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

MaskStore two_masks() {
  MaskStore masks(2);
  masks.set(0, {0, 1, 1});
  masks.set(1, {1});
  return masks;
}

std::vector<std::uint32_t> words_of(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  return words;
}

}  // namespace

TEST_CASE("Removals are written per point of the file and read back per point of the scan") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  write_removals(folder.path() / "deep", scans, two_masks(), [] {});
  // The scan's points stand at positions 0, 2 and 4 of the file; the last two are removed, and
  // what it leaves out is neither kept nor removed.
  CHECK(words_of(folder.path() / "deep/000007.label") ==
        std::vector<std::uint32_t>{9, 0, 251, 0, 251});
  CHECK(words_of(folder.path() / "deep/000008.label") == std::vector<std::uint32_t>{251});

  const MaskStore back = read_removals(folder.path() / "deep", scans, [] {});
  CHECK(back.get(0) == Mask{0, 1, 1});
  CHECK(back.get(1) == Mask{1});
}

TEST_CASE("Ids 251 to 259 mean removed whatever the instance; their neighbours do not") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  const std::uint32_t instance = 7U << 16;
  const std::vector<std::uint32_t> words = {250, 0, 259 | instance, 0, 260 | instance};
  write_atomically(folder.path() / "000007.label",
                   {reinterpret_cast<const char*>(words.data()), words.size() * 4});
  write_atomically(folder.path() / "000008.label", std::string("\xfb\0\0\0", 4));
  const MaskStore masks = read_removals(folder.path(), scans, [] {});
  CHECK(masks.get(0) == Mask{0, 1, 0});
  CHECK(masks.get(1) == Mask{1});
}

TEST_CASE("A missing or cut-off label file is named") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  CHECK_THROWS_AS(read_removals(folder.path() / "none", scans, [] {}), DataError);
  write_removals(folder.path(), scans, two_masks(), [] {});
  write_atomically(folder.path() / "000007.label", std::string(19, '\0'));
  CHECK_THROWS_WITH(read_removals(folder.path(), scans, [] {}),
                    Contains("000007.label") && Contains("19 bytes, expected 20"));
  std::filesystem::remove(folder.path() / "000007.label");
  CHECK_THROWS_WITH(read_removals(folder.path(), scans, [] {}), Contains("000007.label: missing"));
}
