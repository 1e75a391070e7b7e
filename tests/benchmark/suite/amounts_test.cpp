// SPDX-License-Identifier: MIT
#include "benchmark/suite/amounts.h"

#include <catch2/catch.hpp>

#include "core/error.h"

using namespace raymoval;
using Catch::Matchers::Contains;

TEST_CASE("Memory is read in MiB, or with a unit") {
  const auto mib = [](const std::string& text) { return parse_memory_mib("--memory-limit", text); };
  CHECK(mib("2000") == 2000.0);
  CHECK(mib("2GiB") == 2048.0);
  CHECK(mib("2G") == 2048.0);
  CHECK(mib("2g") == 2048.0);
  CHECK(mib("512 MiB") == 512.0);
  CHECK(mib("1.5GiB") == 1536.0);
  // 2e9 bytes are 2e9 / 1048576 MiB.
  CHECK(mib("2GB") == Approx(1907.3486));
  CHECK(mib("500mb") == Approx(476.8372));
  CHECK(mib("2048KiB") == 2.0);
  CHECK(mib("4000000") == 4e6);
  for (const char* wrong : {"", "0", "-1", "GB", "2XB", "2 0", "nan", "inf", "1e300", "2GB2"}) {
    CHECK_THROWS_WITH(mib(wrong), Contains("--memory-limit") && Contains("2GiB"));
  }
}

TEST_CASE("A time is read in seconds, or with a unit") {
  const auto seconds = [](const std::string& text) { return parse_seconds("--time-limit", text); };
  CHECK(seconds("90") == 90.0);
  CHECK(seconds("0.5") == 0.5);
  CHECK(seconds("90s") == 90.0);
  CHECK(seconds("5min") == 300.0);
  CHECK(seconds("5m") == 300.0);
  CHECK(seconds("2h") == 7200.0);
  CHECK(seconds("1 d") == 86400.0);
  for (const char* wrong : {"", "soon", "0", "-5", "5:00", "1h30", "5 minutos"}) {
    CHECK_THROWS_WITH(seconds(wrong), Contains("--time-limit") && Contains("5min"));
  }
}

TEST_CASE("A range says what was meant if it is no range") {
  const auto range = [](const std::string& text) { return parse_range("--range", text); };
  CHECK(range("2.7:50").min == 2.7);
  CHECK(range("2.7:50").max == 50.0);
  CHECK(range(":50").min == RangeLimits{}.min);
  CHECK(range("3:").max == RangeLimits{}.max);
  CHECK_THROWS_WITH(range("50:2"), Contains("MIN comes first: write 2:50."));
  CHECK_THROWS_WITH(range("50"), Contains("Write :50 for at most 50 m, or 50: for at least that."));
  for (const char* wrong : {"", "2-50", "2:x", "-1:5", "5:5", "1:2:3", "nan:5", "2m:50m"}) {
    CHECK_THROWS_WITH(range(wrong), Contains("expected MIN:MAX in metres"));
  }
}
