// SPDX-License-Identifier: MIT
#include "datasets/trajectories/stamps.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

TEST_CASE("times keep every digit of their text", "[trajectories]") {
  CHECK(parse_stamp("1317384506.400000123") == 1317384506400000123);
  CHECK(parse_stamp("1.317384506400000123e+09") == 1317384506400000123);
  CHECK(parse_stamp("-0.5") == -500000000);
  CHECK(parse_stamp("0.1234567895") == 123456790);
  CHECK(parse_stamp(".5") == 500000000);
  CHECK(parse_stamp("7.") == 7000000000);
  CHECK(parse_stamp("1317384506400000123", TimeUnit::kNanoseconds) == 1317384506400000123);
  CHECK(parse_stamp("1317384506400.25", TimeUnit::kMilliseconds) == 1317384506400250000);
  CHECK(parse_stamp("25e-1", TimeUnit::kMicroseconds) == 2500);
  CHECK(parse_stamp("0e999") == 0);
  CHECK(parse_stamp("1e-999") == 0);
}

TEST_CASE("what is no time, or too far, is none", "[trajectories]") {
  for (const char* text :
       {"", ".", "-", "1x", "nan", "inf", "1e", "1.2.3", "0x10", "--1", "1e9999"}) {
    INFO(text);
    CHECK_FALSE(parse_stamp(text));
  }
  CHECK_FALSE(parse_stamp("1317384506400000123"));  // As seconds.
  CHECK(parse_stamp("4400000000") == kMostStamp);
  CHECK_FALSE(parse_stamp("4400000000.1"));
  CHECK_FALSE(parse_stamp("-4400000001"));
  CHECK_FALSE(parse_stamp("1e300"));
}

TEST_CASE("the unit of times is told by their size, else by their spacing", "[trajectories]") {
  CHECK(usual_time_unit(1317384506.4, 0.1) == TimeUnit::kSeconds);
  CHECK(usual_time_unit(1317384506400.0, 100) == TimeUnit::kMilliseconds);
  CHECK(usual_time_unit(1.3173845064e15, 1e5) == TimeUnit::kMicroseconds);
  CHECK(usual_time_unit(1.3173845064e18, 1e8) == TimeUnit::kNanoseconds);
  CHECK(usual_time_unit(0.0, 0.1) == TimeUnit::kSeconds);
  CHECK(usual_time_unit(0.0, 100.0) == TimeUnit::kMilliseconds);
  CHECK(usual_time_unit(0.0, 1e5) == TimeUnit::kMicroseconds);
  // 2 s from the begin, which as seconds would be in 2033, but then poses were years apart.
  CHECK(usual_time_unit(2e9, 1e8) == TimeUnit::kNanoseconds);
  CHECK(usual_time_unit(0.0, 0.0) == TimeUnit::kSeconds);
}

TEST_CASE("names are times only if all of them look like times", "[trajectories]") {
  using Stamps = std::vector<Nanoseconds>;
  const auto read = [](const std::vector<std::string>& names) {
    const auto found = stamps_in_names(names);
    return found ? found->stamps : Stamps{};
  };
  CHECK(read({"1317384506.400000123", "1317384506.500000000"}) ==
        Stamps{1317384506400000123, 1317384506500000000});
  CHECK(read({"1317384506.4", "1317384506.5"}) == Stamps{1317384506400000000, 1317384506500000000});
  for (const char* digits : {"1317384506400", "1317384506400000", "1317384506400000000",
                             "cloud_1317384506_400000000_left", "lidar-1317384506.4"}) {
    INFO(digits);
    CHECK(read({digits}) == Stamps{1317384506400000000});
  }
  CHECK(read({"1317384506_5000000", "1317384506_400000123"}) ==
        Stamps{1317384506005000000, 1317384506400000123});
  // Nanoseconds without leading zeros: decimals of varying length would not end in zeros.
  CHECK(read({"1317384506.5000000", "1317384506.400000123"}) ==
        Stamps{1317384506005000000, 1317384506400000123});
  CHECK(read({"0.000000000", "0.100000000"}) == Stamps{0, 100000000});
  for (const char* name : {"000123", "frame1.10", "1.10", "scan_7", "12345678901234567890", "",
                           ".5", "2011_09_26", "20111001_120000"}) {
    INFO(name);
    CHECK_FALSE(stamps_in_names({name}));
  }
  for (const char* first : {"2011-09-30-12-08-26-400000", "2011_09_30_12_08_26.4",
                            "20110930T120826.400", "vlp_2011-09-30T12:08:26.4Z"}) {
    INFO(first);
    const std::string second = std::string(first).replace(std::string(first).find("26"), 2, "27");
    CHECK(read({second, first}) == Stamps{1317384507400000000, 1317384506400000000});
  }
  // The date of the recording, and the number of the scan.
  CHECK_FALSE(stamps_in_names({"20110930_120826_000001", "20110930_120826_000002"}));
  CHECK_FALSE(stamps_in_names({"20110930_120826_1", "20110930_120826_2"}));
  CHECK_FALSE(stamps_in_names({"1317384506.400000000", "000001"}));
  CHECK_FALSE(stamps_in_names({}));
  // The ninth and the tenth of a second are not one time.
  CHECK_FALSE(stamps_in_names({"1.1", "1.2", "1.9", "1.10"}));
  // The serial number of a sensor and a count of microseconds: no sensor is that fast.
  CHECK_FALSE(stamps_in_names({"livox_1100594001_000001", "livox_1100594001_000002"}));
}

TEST_CASE("digits behind the seconds of a name are read as they must have been written",
          "[trajectories]") {
  using Stamps = std::vector<Nanoseconds>;
  const auto read = [](const std::vector<std::string>& names) {
    Stamps stamps = stamps_in_names(names).value().stamps;
    for (Nanoseconds& stamp : stamps) stamp -= 1403636579'000000000;
    return stamps;
  };
  // Python's str drops zeros at the end.
  CHECK(read({"1403636579.8", "1403636579.87", "1403636579.9637"}) ==
        Stamps{800000000, 870000000, 963700000});
  CHECK(read({"1403636579_870000", "1403636579_963700"}) == Stamps{870000000, 963700000});
  CHECK(read({"1403636579_70000", "1403636579_170000"}) == Stamps{70000000, 170000000});
  CHECK(stamps_in_names({"0.0", "0.1", "0.2037", "5.90125"}).value().stamps ==
        Stamps{0, 100000000, 203700000, 5901250000});
  // As decimals 0.99998 and 0.199998 s; as microseconds without leading zeros 0.1 s apart.
  const auto both = stamps_in_names(
      {"1403636579_99998", "1403636579_199998", "1403636579_299998", "1403636579_399998"});
  CHECK(both.value().stamps[1] - both.value().stamps[0] == 100000000);
  CHECK_THAT(both.value().note, Catch::Contains("microseconds"));
  // Neither is more even than the other, but the poses end at 0.2 s.
  const Nanoseconds second = 1403636579'000000000;
  const std::vector<std::string> two = {"1403636579_99999", "1403636579_199999"};
  CHECK(stamps_in_names(two, std::pair(second, second + 200000000)).value().stamps[0] ==
        second + 99999000);
}

TEST_CASE("files of times hold numbers or the dates of KITTI's raw data", "[trajectories]") {
  const TemporaryFolder folder;
  const auto dates = folder.write("timestamps.txt",
                                  "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.067698956\n");
  // date -u -d "2011-09-26 13:02:25" +%s gives 1317042145.
  CHECK(read_stamp_file(dates).stamps ==
        std::vector<Nanoseconds>{1317042145964389445, 1317042146067698956});
  const auto nanoseconds = folder.write("ns.txt", "1317384506400000123\n1317384506500000123\n");
  CHECK(read_stamp_file(nanoseconds).stamps.back() == 1317384506500000123);
  CHECK(read_stamp_file(nanoseconds).since_first.back() == 0.1);
  const auto mixed = folder.write("mixed.txt", "2011-09-26 13:02:25.9\n# none\n7.5\n");
  check_says(message_of<DataError>([&] { read_stamp_file(mixed); }),
             {"mixed.txt: line 3", "'7.5' is not a date"});
  const auto bad = folder.write("bad.txt", "2011-13-26 13:02:25.9\n");
  check_says(message_of<DataError>([&] { read_stamp_file(bad); }), {"bad.txt: line 1"});
}
