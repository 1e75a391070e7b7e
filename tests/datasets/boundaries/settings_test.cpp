// SPDX-License-Identifier: MIT
// Settings of a sequence, and their consequences.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

void write_two(const TemporaryFolder& folder, const std::string& settings = "{}") {
  folder.write("0.bin", floats({1, 2, 3, 4}));
  folder.write("1.bin", floats({1, 2, 3, 4}));
  folder.write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n" + kIdentityRow);
  folder.write("sequence.json", settings);
}

std::string settings_error(const std::string& settings) {
  const TemporaryFolder folder;
  write_two(folder, settings);
  return message_of<ConfigurationError>([&] { open_sequence(folder.text(), {}); });
}

}  // namespace

TEST_CASE("settings of a wrong kind are told", "[settings]") {
  check_says(settings_error(R"({"sensor": "estimate"})"), {"Did you mean 'estimated'?"});
  check_says(settings_error(R"({"up": {"x": 0, "y": 0, "z": 1}})"), {"up", "is not a direction"});
  check_says(settings_error(R"({"up": [0, 1]})"), {"up", "is not a direction"});
  check_says(settings_error(R"({"drop_ego": true})"), {"drop_ego", "expected a text in quotes"});
}

TEST_CASE("a unit of time that does not exist is refused also where nothing is deskewed",
          "[settings]") {
  check_says(settings_error(R"({"point_time_unit": "min"})"),
             {"sequence.json", "point_time_unit", "s, ms, us, ns"});
  const TemporaryFolder folder;
  write_two(folder, R"({"point_time_unit": "us"})");
  SequenceOptions options;
  options.point_time_unit = "min";
  check_says(message_of<UsageError>([&] { open_sequence(folder.text(), options); }),
             {"--point-time-unit min", "s, ms, us, ns"});
  CHECK(open_sequence(folder.text(), {}).point_time_unit == "us");
  for (const char* unit : {"s", "ms", "ns", "1e-5"}) {
    options.point_time_unit = unit;
    CHECK(open_sequence(folder.text(), options).point_time_unit == unit);
  }
}

TEST_CASE("a label rule as an option makes labels of intensities", "[dynamicmap]") {
  const TemporaryFolder folder;
  folder.write("pcd/0.pcd",
               "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 1\nHEIGHT 1\nVIEWPOINT "
               "0 0 0 1 0 0 0\nDATA ascii\n1 2 3 1\n");
  CHECK_FALSE(open_sequence(folder.text(), {}).labels);
  SequenceOptions options;
  options.label_rule = folder.write("rule.json", R"({"moving": [1]})");
  CHECK(open_sequence(folder.text(), options).labels);
}
