// SPDX-License-Identifier: MIT
#include "datasets/world_axes/up_direction.h"

#include <catch2/catch.hpp>

#include "datasets/open_sequence.h"
#include "datasets/reading/fingerprint.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

TEST_CASE("up is an axis or three numbers of any length", "[up]") {
  CHECK(parse_up("z") == Vector3d(0, 0, 1));
  CHECK(parse_up("+x") == Vector3d(1, 0, 0));
  CHECK(parse_up("-y") == Vector3d(0, -1, 0));
  CHECK(parse_up("0,-3,0") == Vector3d(0, -1, 0));
  CHECK(parse_up("1e300,0,1e300")->isApprox(Vector3d(1, 0, 1).normalized()));
  for (const char* bad :
       {"", "-", "w", "zz", "0,0,0", "1,2", "1,2,3,4", "nan,0,1", "1,,2", "a,b,c"}) {
    INFO(bad);
    CHECK_FALSE(parse_up(bad).has_value());
  }
}

TEST_CASE("up is told as it was meant", "[up]") {
  CHECK(axis_text({0, -1, 0}) == "-y");
  CHECK(axis_text({0, 0, 1}) == "z");
  CHECK(axis_text(Vector3d(0, 0.6, 0.8)) == "0.000,0.600,0.800");
  CHECK(up_line({}).empty());
  CHECK_THAT(up_line({{0, -1, 0}, UpDirection::Source::kEstimated}),
             Contains("up is -y of the world") && Contains("estimated"));
  CHECK_THAT(up_line({{0, -1, 0}, UpDirection::Source::kGiven}), Contains("as given"));
}

TEST_CASE("an option stands above sequence.json, and both above the estimate", "[up][slow]") {
  SequenceOptions options;
  CHECK(open_sequence("street", options).up().is_world_z());
  options.up = "-y";
  const Sequence given = open_sequence("street", options);
  CHECK(given.up().direction == Vector3d(0, -1, 0));
  CHECK(given.up().source == UpDirection::Source::kGiven);
  CHECK(given.record().up == "-y");
  CHECK(given.record().up_source == "given");
  // Another up is another way to read the data: stored results are of the one or the other.
  CHECK(fingerprint(given, 1) != fingerprint(open_sequence("street", {}), 1));
  options.up = "z";
  CHECK(fingerprint(open_sequence("street", options), 1) ==
        fingerprint(open_sequence("street", {}), 1));
  options.up = "sideways";
  CHECK_THROWS_WITH(open_sequence("street", options), Contains("--up sideways: expected an axis"));
}

TEST_CASE("sequence.json may say which way is up", "[up]") {
  const test::TemporaryFolder folder;
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.write("a.bin", std::string(16, '\0'));
  const auto up_with = [&](const std::string& value) {
    folder.write("sequence.json", "{\"up\": " + value + "}");
    return open_sequence(folder.text(), {}).up().direction;
  };
  CHECK(up_with("\"-y\"") == Vector3d(0, -1, 0));
  CHECK(up_with("[0, 2, 0]") == Vector3d(0, 1, 0));
  for (const char* bad : {"\"\"", "\"down\"", "[0, 0, 0]", "[1, 2]", "1", "[\"a\", 0, 1]"}) {
    CHECK_THROWS_WITH(up_with(bad), Contains("sequence.json: up") && Contains("not a direction"));
  }
}
