// SPDX-License-Identifier: MIT
#include "datasets/clouds/frames.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::vector<NumberedFile> numbered(const std::vector<long>& numbers) {
  std::vector<NumberedFile> files;
  for (const long number : numbers) files.push_back({number, {}});
  return files;
}

std::vector<long> numbers_of(const ChosenFrames& chosen) {
  std::vector<long> numbers;
  for (const NumberedFile& file : chosen.files) numbers.push_back(file.number);
  return numbers;
}

}  // namespace

TEST_CASE("a frame range has three parts, each of which may be empty", "[frames]") {
  const FrameRange whole = parse_frame_range("2350:2670:2");
  CHECK(whole.first == 2350);
  CHECK(whole.last == 2670);
  CHECK(whole.stride == 2);
  const FrameRange every_third = parse_frame_range("::3");
  CHECK_FALSE(every_third.first);
  CHECK_FALSE(every_third.last);
  CHECK(every_third.stride == 3);
  CHECK(parse_frame_range("5:").first == 5);
  CHECK(parse_frame_range(":7").last == 7);
  CHECK(parse_frame_range("5:5:").stride == 1);
  for (const char* text : {"2350:2670:2", "::3", "5::1", ":7:1"}) {
    CHECK(frame_range_text(parse_frame_range(text)) == text);
  }
}

TEST_CASE("a frame range that makes no sense says what the form is", "[frames]") {
  for (const char* text : {"", "7", "1:2:3:4", "a:2", "1:b", "1:2:0", "-1:2", "1:2:-1", "1.5:2",
                           "9:3", "1:99999999999999999999", " 1:2"}) {
    CAPTURE(text);
    const auto message = message_of<UsageError>([&] { parse_frame_range(text); });
    check_says(message, {"'" + std::string(text) + "'", "FIRST:LAST or FIRST:LAST:STRIDE"});
  }
}

TEST_CASE("a range selects with its ends included and strides from its start", "[frames]") {
  const auto files = numbered({3, 4, 5, 6, 7, 8});
  CHECK(numbers_of(choose_frames(files, parse_frame_range("4:8:2"), "d")) ==
        std::vector<long>{4, 6, 8});
  CHECK(numbers_of(choose_frames(files, parse_frame_range("4:7:2"), "d")) ==
        std::vector<long>{4, 6});
  CHECK(numbers_of(choose_frames(files, parse_frame_range("::2"), "d")) ==
        std::vector<long>{3, 5, 7});
  CHECK(numbers_of(choose_frames(files, parse_frame_range("7:"), "d")) == std::vector<long>{7, 8});
  CHECK(numbers_of(choose_frames(files, parse_frame_range("::9223372036854775807"), "d")) ==
        std::vector<long>{3});
  CHECK(frame_range_text(choose_frames(files, parse_frame_range("::2"), "d").range) == "3:8:2");
}

TEST_CASE("a range outside the data says which frames there are", "[frames]") {
  const auto files = numbered({3, 4, 5});
  for (const char* text : {"2:4", "4:6", "8:9", "6:", ":2"}) {
    const auto message =
        message_of<DataError>([&] { choose_frames(files, parse_frame_range(text), "data/05"); });
    check_says(message, {"data/05", text, "reaches outside the data", "3 frames from 3 to 5"});
  }
}

TEST_CASE("a gap is an error inside a given range and part of a whole sequence", "[frames]") {
  const auto files = numbered({0, 1, 3, 4});
  for (const char* range : {"0:4", "0:", ":4", "1:", ":3", "1:3"}) {
    const auto says =
        message_of<DataError>([&] { choose_frames(files, parse_frame_range(range), "d"); });
    check_says(says, {"no file for frame 2", "4 frames from 0 to 4"});
  }
  CHECK(choose_frames(files, parse_frame_range("3:"), "d").files.size() == 2);
  CHECK(choose_frames(files, parse_frame_range(":1"), "d").files.size() == 2);
  CHECK(choose_frames(files, parse_frame_range("3:3"), "d").files.size() == 1);
  CHECK(numbers_of(choose_frames(files, {}, "d")) == std::vector<long>{0, 1, 3, 4});
  // The stride steps over the gap: 1, 3.
  CHECK(numbers_of(choose_frames(files, parse_frame_range("1:4:2"), "d")) ==
        std::vector<long>{1, 3});
}

TEST_CASE("names sort naturally", "[frames]") {
  CHECK(natural_less("scan_2.pcd", "scan_10.pcd"));
  CHECK_FALSE(natural_less("scan_10.pcd", "scan_2.pcd"));
  CHECK(natural_less("000009", "000010"));
  CHECK(natural_less("a", "ab"));
  CHECK(natural_less("a1b2", "a1b10"));
  CHECK(natural_less("9", "10"));
  CHECK_FALSE(natural_less("10", "9"));
  CHECK(natural_less("01", "2"));
  CHECK(natural_less("002", "03"));
  CHECK(natural_less("2abc", "10"));
  CHECK(natural_less("az", "b"));
  CHECK(natural_less("a10", "a:"));  // ':' follows '9'.
  CHECK_FALSE(natural_less("a:", "a10"));
  CHECK_FALSE(natural_less("a.", "a--"));
  CHECK_FALSE(natural_less("b", "ab"));
  CHECK_FALSE(natural_less("ab", "a"));
  CHECK_FALSE(natural_less("", ""));
  CHECK(natural_less("", "a"));
  CHECK(natural_less("1", "a"));
  CHECK_FALSE(natural_less("a", "1"));
  CHECK(natural_less("a01", "a1"));  // Only the zeros differ.
  CHECK(natural_less("01", "1") != natural_less("1", "01"));
  CHECK_FALSE(natural_less("7", "7"));
}

TEST_CASE("numbered files are listed by number, and strange names are errors", "[frames]") {
  const TemporaryFolder folder;
  for (const char* name : {"10.bin", "9.bin", ".hidden.bin", "note.txt"}) folder.write(name, "x");
  const auto files = list_numbered_files(folder.text(), ".bin");
  REQUIRE(files.size() == 2);
  CHECK(files[0].number == 9);
  CHECK(files[1].number == 10);
  folder.write("010.bin", "x");
  check_says(message_of<DataError>([&] { list_numbered_files(folder.text(), ".bin"); }),
             {"frame 10 is already", "10.bin"});
  for (const std::string odd : {"0000x.bin", "-1.bin"}) {
    folder.write(odd, "x");
    check_says(message_of<DataError>([&] { list_numbered_files(folder.text(), ".bin"); }),
               {odd, "not a frame number"});
    std::filesystem::remove(folder / odd);
  }
  check_says(message_of<DataError>([&] { list_numbered_files(folder.text(), ".pcd"); }),
             {"holds no *.pcd"});
}
