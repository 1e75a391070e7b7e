// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_summary.h"

#include <catch2/catch.hpp>

using namespace raymoval;
using Catch::Matchers::Contains;

TEST_CASE("What was removed is counted by distance from the sensor") {
  Scan scan;
  scan.points = {{5, 0, 0}, {0, 10, 0}, {0, 0, 19.9F}, {0, 300, 0}, {1, 0, 0}};
  RangeShares shares;
  shares.add(scan, {1, 0, 1, 0, 2});  // The last one is in no output.
  const std::string table = shares.table();
  CHECK_THAT(table, Contains("   0-10 m               1             1  100.00 %\n"));
  CHECK_THAT(table, Contains("  10-20 m               2             1   50.00 %\n"));
  CHECK_THAT(table, Contains("    80+ m               1             0    0.00 %\n"));
  CHECK_THAT(table, !Contains("20-40 m"));
}

TEST_CASE("What to try follows from what was done") {
  const auto advice = [](std::uint64_t removed, const std::string& method,
                         const std::vector<Finding>& warned, bool is_seen) {
    std::string text;
    for (const std::string& line : remedies(removed, 10000, "data", method, warned, is_seen)) {
      text += line + '\n';
    }
    return text;
  };
  CHECK_THAT(advice(1, "noop", {}, false),
             Contains("--method raymoval_plus:offline") && Contains("--html"));
  CHECK_THAT(advice(1, "raymoval_plus:offline", {}, true),
             Contains("inspect data") && !Contains("--method") && !Contains("--html"));
  CHECK_THAT(advice(500, "noop", {}, false), !Contains("little was removed"));
  Finding skewed;
  skewed.check = "scans-skewed";
  CHECK_THAT(advice(500, "noop", {skewed, skewed}, false),
             Contains("correct the mistakes in the data: scans-skewed."));
}
