// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/removal_files.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <nlohmann/json.hpp>

#include "benchmark/result/removals/reasons.h"
#include "benchmark/result/sealed_json.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
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
  // The scan's points are at positions 0, 2 and 4 of the file; the last two are removed, and points
  // that the scan leaves out are neither kept nor removed.
  CHECK(words_of(folder.path() / "deep/000007.label") ==
        std::vector<std::uint32_t>{9, 0, 251, 0, 251});
  CHECK(words_of(folder.path() / "deep/000008.label") == std::vector<std::uint32_t>{251});

  const MaskStore back = read_removals(folder.path() / "deep", scans, [] {});
  CHECK(back.get(0) == Mask{0, 1, 1});
  CHECK(back.get(1) == Mask{1});
}

TEST_CASE("The labels of predictions are told, so that masks of 0 and 1 can be noticed") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  const auto found_with = [&](std::uint32_t last) {
    // The scan's points are at positions 0, 2 and 4; the upper half of a word is an instance.
    const std::vector<std::uint32_t> words = {1, 77, 7U << 16, 251, last};
    write_atomically(folder.path() / "000007.label",
                     {reinterpret_cast<const char*>(words.data()), words.size() * 4});
    write_atomically(folder.path() / "000008.label", std::string(4, '\0'));
    return read_predictions(folder.path(), scans, LabelRule{}, [] {});
  };
  CHECK(label_ids_text(found_with(1).found.ids) == "0, 1");
  for (const std::uint32_t removed : {251U, 259U}) {
    CHECK(found_with(removed).masks.removed_count() == 1);
  }
  for (const std::uint32_t other : {1U, 250U, 260U}) {
    CHECK(found_with(other).masks.removed_count() == 0);
  }
  LabelIds many;
  for (std::size_t id = 10; id < 20; ++id) many.set(id);
  CHECK(label_ids_text(many) == "10, 11, 12, 13, 14, 15, 16, 17 and 2 more");
}

TEST_CASE("Learning ids, ids of a rule and arrays are read as other programs write them") {
  const test::TwoScans scans;  // Points at positions 0, 2 and 4 of five, and one of one.
  const test::TemporaryFolder folder;
  const auto labels = [&](const std::vector<std::uint32_t>& words) {
    folder.write("000007.label", test::words(words));
    folder.write("000008.label", test::words({words[0]}));
    return read_predictions(folder.path(), scans, LabelRule{"mine", {7}, {}}, [] {});
  };
  const Predictions learning = labels({1, 0, 2, 0, 0});
  CHECK(learning.masks.get(0) == Mask{0, 1, 0});
  CHECK_THAT(learning.note, Contains("learning ids"));
  const Predictions ruled = labels({1, 0, 7, 0, 2});
  CHECK(ruled.masks.get(0) == Mask{0, 1, 0});
  CHECK_THAT(ruled.note, Contains("label rule mine: 7"));
  CHECK(labels({9, 0, 251, 0, 7}).masks.get(0) == Mask{0, 1, 0});
  CHECK(labels({9, 0, 251, 0, 7}).note.empty());
  // In label files of 0 and 1, the meaning of 1 is unknown.
  CHECK(labels({0, 0, 1, 0, 1}).masks.removed_count() == 0);

  const auto array = [&](const std::string& type, const std::string& five, const std::string& one) {
    for (const auto& [name, count, body] :
         {std::tuple{"000007.npy", "5", five}, std::tuple{"000008.npy", "1", one}}) {
      std::string head =
          "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + count + ",), }\n";
      folder.write(name, "\x93NUMPY\x01" + std::string(1, '\0') + static_cast<char>(head.size()) +
                             std::string(1, '\0') + head + body);
    }
    return read_predictions(folder.path(), scans, LabelRule{}, [] {}).masks.get(0);
  };
  for (const char* type : {"|b1", "|u1"}) {
    CHECK(array(type, std::string("\0\1\1\0\0", 5), std::string(1, '\0')) == Mask{0, 1, 0});
  }
  CHECK(array("<f4", test::floats({0.4F, 1, 0.5F, 1, 0.499F}), test::floats({0})) == Mask{0, 1, 0});
  CHECK_THROWS_WITH(array("|u1", "1234", "1"), Contains("000007.npy") && Contains("5 points"));
}

TEST_CASE("Predictions of MOS benchmarks are found in sequences/NN/predictions") {
  const test::TemporaryFolder folder;
  CHECK(prediction_folder(folder.path(), "08") == folder.path());
  folder.write("sequences/05/predictions/000000.label", "");
  CHECK(prediction_folder(folder.path(), "08") == folder / "sequences/05/predictions");
  folder.write("sequences/08/000000.label", "");
  CHECK(prediction_folder(folder.path(), "08") == folder / "sequences/08");
  CHECK_THROWS_WITH(prediction_folder(folder.path(), "09"), Contains("05/, 08/"));
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

TEST_CASE("Whoever gives the folder above that of the label files is told which one to name") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  for (const char* below : {"labels", "predictions", "removals"}) {
    const std::filesystem::path above = folder.path() / (std::string("of ") + below);
    write_removals(above / below, scans, two_masks(), [] {});
    CHECK_THROWS_WITH(read_removals(above, scans, [] {}),
                      Contains("holds no 000007.label, but its folder " + std::string(below) +
                               "/ does. Name that one."));
  }
  CHECK_THROWS_WITH(read_removals(folder.path() / "none", scans, [] {}),
                    Contains("none: no such folder; expected one with"));
  const auto file = folder.write("file", "x");
  CHECK_THROWS_WITH(read_removals(file, scans, [] {}), Contains("file: is not a folder; expected"));
  CHECK_THROWS_WITH(write_removals(file / "below", scans, two_masks(), [] {}),
                    Contains("file/below: cannot be made") && Contains("Choose another folder"));
  write_removals(folder.path() / "both", scans, two_masks(), [] {});
  write_removals(folder.path() / "both/labels", scans, two_masks(), [] {});
  CHECK(read_removals(folder.path() / "both", scans, [] {}).get(1) == Mask{1});
  // A later scan that is missing is named itself.
  write_removals(folder.path() / "some", scans, two_masks(), [] {});
  std::filesystem::create_directories(folder.path() / "some/labels");
  std::filesystem::rename(folder.path() / "some/000008.label",
                          folder.path() / "some/labels/000008.label");
  CHECK_THROWS_WITH(read_removals(folder.path() / "some", scans, [] {}),
                    Contains("000008.label: missing"));
}

TEST_CASE("A point that is neither kept nor removed is written as such, and read as kept") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  write_removal(folder.path(), scans.load(0), {kLeftOutMask, 1, 0});
  CHECK(words_of(folder.path() / "000007.label") == std::vector<std::uint32_t>{0, 0, 251, 0, 9});
  write_removal(folder.path(), scans.load(1), {0});
  CHECK(read_removals(folder.path(), scans, [] {}).get(0) == Mask{0, 1, 0});
}

TEST_CASE(
    "A folder of removals goes with all that a run writes there, and stays for anything else") {
  const test::TemporaryFolder folder;
  const std::filesystem::path place = folder.path() / "removals";
  CHECK(remove_removals(place));  // It is not there.
  const auto fill = [&] {
    for (const char* name : {"000007.label", "000007.reason", "reasons.json"}) {
      (void)folder.write("removals/" + std::string(name), "x");
    }
    write_atomically(new_part_name(place / "000008.label"), "half");
    write_atomically(new_part_name(place / "reasons.json"), "half");
  };
  fill();
  CHECK(remove_removals(place));
  CHECK_FALSE(std::filesystem::exists(place));
  fill();
  const std::vector<std::filesystem::path> foreign = {place / "notes.txt", place / "other.json",
                                                      new_part_name(place / "notes.txt")};
  for (const auto& file : foreign) write_atomically(file, "mine");
  CHECK_FALSE(remove_removals(place));
  for (const auto& file : foreign) CHECK(read_text(file) == "mine");
  // No file is deleted then, because a cell is beside these removals.
  CHECK(std::distance(std::filesystem::directory_iterator(place), {}) == 8);
  // A link is deleted without its target.
  std::filesystem::create_symlink(place, folder.path() / "link");
  CHECK(remove_removals(folder.path() / "link"));
  CHECK_FALSE(std::filesystem::is_symlink(folder.path() / "link"));
  CHECK(read_text(place / "000007.label") == "x");
}

TEST_CASE("Reasons are written for scans that have some, and refused where they do not fit") {
  const test::TwoScans scans;
  const test::TemporaryFolder folder;
  CHECK(Reasons{}.empty());
  CHECK(read_reason_sentences(folder.path()).empty());
  write_reasons(folder.path(), scans, {{}, {{0}, {0}}});  // Without sentences there are none.
  CHECK(std::filesystem::is_empty(folder.path()));
  CHECK(read_reasons(folder.path(), scans.load(0), 2).empty());
  write_reasons(folder.path(), scans, {{"near", "far"}, {{}, {1}}});
  CHECK_FALSE(std::filesystem::exists(folder.path() / "000007.reason"));
  CHECK(read_reason_sentences(folder.path()) == std::vector<std::string>{"near", "far"});
  CHECK(read_reasons(folder.path(), scans.load(1), 2) == std::vector<std::uint8_t>{1});
  CHECK(read_reasons(folder.path(), scans.load(1), 0).empty());
  CHECK_THROWS_WITH(read_reasons(folder.path(), scans.load(1), 1),
                    Contains("000008.reason: does not fit its scan of 1 points"));
  (void)folder.write("000008.reason", std::string(2, '\0'));
  CHECK_THROWS_WITH(read_reasons(folder.path(), scans.load(1), 2), Contains("does not fit"));
  CHECK(is_reason_file("reasons.json"));
  CHECK(is_reason_file("000007.reason"));
  CHECK_FALSE(is_reason_file("000007.label"));
  CHECK_FALSE(is_reason_file("other.json"));
  write_sealed(folder.path() / "reasons.json", {{"sentences", 7}});
  CHECK_THROWS_WITH(
      read_reason_sentences(folder.path()),
      Contains("reasons.json: not the reasons of a method") && Contains("--keep-removals"));
}
