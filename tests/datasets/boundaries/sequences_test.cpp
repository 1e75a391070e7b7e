// SPDX-License-Identifier: MIT
// Messages of a sequence on its files, at the limits between left out, chosen and refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// A folder with one scan of rows x y z reflectance.
Sequence one_scan(const TemporaryFolder& folder, const std::vector<float>& values) {
  folder.write("000000.bin", floats(values));
  folder.write("poses.txt", kIdentityRow);
  return open_sequence(folder.text(), {});
}

std::string world_pcd(const std::string& fields, const std::string& viewpoint,
                      const std::string& row) {
  const bool intensity = fields != "x y z";
  return "FIELDS " + fields + "\nSIZE 4 4 4" + (intensity ? " 4" : "") + "\nTYPE F F F" +
         (intensity ? " F" : "") + "\nWIDTH 1\nHEIGHT 1\nVIEWPOINT " + viewpoint +
         "\nDATA ascii\n" + row + "\n";
}

}  // namespace

TEST_CASE("scans without times are a period apart", "[files]") {
  const TemporaryFolder folder;
  for (const char* name : {"a.bin", "b.bin", "c.bin"}) write_cloud(folder / name, {{1, 2, 3}});
  folder.write("poses.txt", kIdentityRow + kIdentityRow + kIdentityRow);
  CHECK(open_sequence(folder.text(), {}).scans->load(2).time_s == 2 * 0.1);
  folder.write("sequence.json", R"({"scan_period_s": 0.5})");
  CHECK(open_sequence(folder.text(), {}).scans->load(2).time_s == 1.0);
  folder.write("sequence.json", R"({"scan_period_s": 0})");
  CHECK_THROWS_WITH(open_sequence(folder.text(), {}), Catch::Contains("a number above 0"));
}

TEST_CASE("ranges of an option are checked like those of a file", "[settings]") {
  const TemporaryFolder folder;
  (void)one_scan(folder, {1, 2, 3, 4});
  const auto opened = [&](double min, double max) {
    SequenceOptions options;
    options.range_m = RangeLimits{min, max};
    return open_sequence(folder.text(), options).range_m;
  };
  CHECK(opened(0, 0.5).max == 0.5);
  for (const auto& [min, max] :
       std::vector<std::pair<double, double>>{{-1, 5}, {5, 5}, {6, 5}, {std::nan(""), 5}}) {
    CHECK_THROWS_AS(opened(min, max), ConfigurationError);
  }
}

TEST_CASE("a missing return stored as zero is none in a world far from its origin either",
          "[no-returns]") {
  for (const char* place : {"8000 0 0", "8001 0 0", "691000.25 5336000.5 512"}) {
    const TemporaryFolder folder;
    folder.write("pcd/0.pcd", world_pcd("x y z", std::string(place) + " 1 0 0 0", "0 0 0"));
    const Sequence sequence = open_sequence(folder.text(), {});
    CHECK(sequence.scans->load(0).points.empty());
  }
}

TEST_CASE("what is left out of the own vehicle is told once something was read", "[ego]") {
  const TemporaryFolder folder;
  folder.write("sequence.json", R"({"drop_ego": 1.5})");
  const Sequence one = one_scan(folder, {9, 0, 0, 0});
  CHECK(left_out_lines(one).empty());
  (void)one.scans->load(0);
  CHECK(
      left_out_lines(one) ==
      std::vector<std::string>{"no point is on the ego vehicle (nearer than 1.5 m) and left out"});
  const Sequence two = one_scan(folder, {9, 0, 0, 0, 1, 0, 0, 0});
  (void)two.scans->load(0);
  CHECK(left_out_lines(two) ==
        std::vector<std::string>{"50.0 % of the stored points are on the ego vehicle (nearer than "
                                 "1.5 m) and are left out"});
}
