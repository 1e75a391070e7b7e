// SPDX-License-Identifier: MIT
// Missing returns: NaN, or at the origin. No method gets them, and labels and masks keep the places
// of all stored points.
#include <cmath>
#include <limits>

#include "core/error.h"
#include "datasets/clouds/file_source.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

const float kNone = std::nanf("");
const float kInfinity = std::numeric_limits<float>::infinity();

/// One scan of rows x y z intensity in a folder with a pose file in the LiDAR's frame.
void write_scan(const TemporaryFolder& folder, const std::vector<float>& values) {
  folder.write("000000.bin", floats(values));
  folder.write("poses.txt", kIdentityRow);
}

std::string organised_pcd(const std::string& viewpoint, const std::string& rows) {
  return "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
         "WIDTH 3\nHEIGHT 2\nVIEWPOINT " +
         viewpoint + "\nPOINTS 6\nDATA ascii\n" + rows;
}

}  // namespace

TEST_CASE("no returns are left out at any share, and labels keep their places", "[no-returns]") {
  const TemporaryFolder folder;
  // Of six points only 2 and 5 are returns: the others are NaN (also in one coordinate) or zero.
  write_scan(folder, {kNone, kNone, kNone, 0, 0, 0,     0, 0, 2, 0, 1, 0.5F,  //
                      0,     -0.F,  0,     7, 1, kNone, 0, 0, 5, 1, 0, 0.25F});
  folder.write("labels/000000.label", words({9, 9, 40, 9, 252, 252}));
  const Sequence sequence = open_sequence(folder.text(), {});
  const Scan scan = sequence.scans->load(0);
  REQUIRE(scan.size() == 2);
  CHECK(scan.points[0] == Eigen::Vector3f(2, 0, 1));
  CHECK(scan.points[1] == Eigen::Vector3f(5, 1, 0));
  CHECK(scan.reflectance == std::vector<float>{0.5F, 0.25F});
  CHECK(scan.stored_point_count == 6);
  CHECK(scan.stored_index == std::vector<std::uint32_t>{2, 5});
  CHECK(sequence.labels->labels(scan) == std::vector<std::uint32_t>{40, 252});
  // Said once, however often the scan is read.
  (void)sequence.scans->load(0);
  CHECK(left_out_lines(sequence) ==
        std::vector<std::string>{"66.7 % of the stored points are missing returns (NaN or at the "
                                 "origin) and are left out"});
}

TEST_CASE("an organised cloud with NaN opens like any other", "[no-returns]") {
  const TemporaryFolder folder;
  folder.write("0.pcd", organised_pcd("0 0 0 1 0 0 0",
                                      "nan nan nan 0\n1 0 0 3\n0 0 0 0\nnan nan nan 0\n"
                                      "4 0 0 5\nnan nan nan nan\n"));
  folder.write("poses.txt", kIdentityRow);
  const Scan scan = open_sequence(folder.text(), {}).scans->load(0);
  CHECK(scan.stored_index == std::vector<std::uint32_t>{1, 4});
  CHECK(scan.reflectance == std::vector<float>{3, 5});
}

TEST_CASE("in the world frame a no return is at its origin or at the sensor", "[no-returns]") {
  const TemporaryFolder folder;
  // The sensor is at (100, 0, 2). Point 0 is at the world's origin, 1 at the sensor, 2 is NaN
  // with an intensity that is no label; 3 to 5 are returns, the third 0.5 m from the world's
  // origin.
  folder.write("pcd/000000.pcd", organised_pcd("100 0 2 1 0 0 0",
                                               "0 0 0 0\n100 0 2 0\nnan nan nan nan\n"
                                               "110 0 2 1\n100 5 2 0\n0.5 0 0 1\n"));
  folder.write("sequence.json", R"({"labels": {"moving": [1]}})");
  const Sequence sequence = open_sequence(folder.text(), {});
  const Scan scan = sequence.scans->load(0);
  CHECK(scan.stored_index == std::vector<std::uint32_t>{3, 4, 5});
  CHECK(scan.points[0] == Eigen::Vector3f(10, 0, 0));
  CHECK(sequence.labels->labels(scan) == std::vector<std::uint32_t>{1, 0, 1});
  CHECK_THAT(left_out_lines(sequence).at(0), Catch::Contains("50.0 %"));
}

TEST_CASE("a scan may be without a return, and infinite points are damage", "[no-returns]") {
  const TemporaryFolder empty, infinite;
  write_scan(empty, {kNone, 0, 0, 0, 0, 0, 0, 0});
  const Sequence none = open_sequence(empty.text(), {});
  CHECK(none.scans->load(0).points.empty());
  CHECK(none.scans->load(0).stored_point_count == 2);
  CHECK(of_kept_points(none.scans->load(0), {7, 7}).empty());
  write_scan(infinite, {kInfinity, 0, 0, 0, 1, 0, 0, 0});
  const Sequence damaged = open_sequence(infinite.text(), {});
  check_says(message_of<DataError>([&] { (void)damaged.scans->load(0); }),
             {"1 of 2 points are infinite", "as NaN"});
}
