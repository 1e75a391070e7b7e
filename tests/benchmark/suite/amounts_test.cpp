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
