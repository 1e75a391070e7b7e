// SPDX-License-Identifier: MIT
#include "core/text.h"

#include <bit>
#include <catch2/catch.hpp>
#include <clocale>
#include <cmath>
#include <limits>
#include <locale>
#include <random>

using namespace raymoval;

namespace {

struct CommaPoint : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

/// While it lives numbers are written with a comma, by C too if the system has such a locale.
class CommaLocale {
 public:
  CommaLocale() : before_(std::locale::global(std::locale(std::locale(), new CommaPoint))) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
  }
  ~CommaLocale() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  std::locale before_;
};

}  // namespace

TEST_CASE("plain numbers have no exponent as long as they are whole") {
  CHECK(number_text(100000.0) == "1e+05");
  CHECK(plain_number_text(100000.0) == "100000");
  CHECK(plain_number_text(-1e9) == "-1000000000");
  CHECK(plain_number_text(2e9) == "2e+09");
  CHECK(plain_number_text(0.25) == "0.25");
  CHECK(plain_number_text(std::numeric_limits<double>::infinity()) == "inf");
}

TEST_CASE("A number's text is the shortest that reads back as the same bits") {
  CHECK(number_text(0.1) == "0.1");
  CHECK(number_text(0.2 + 0.1) == "0.30000000000000004");
  CHECK(number_text(-3.0) == "-3");
  CHECK(number_text(-0.0) == "-0");
  CHECK(number_text(1e300) == "1e+300");
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const auto back = parse_number<double>(number_text(value));
    REQUIRE(back.has_value());
    REQUIRE(std::bit_cast<std::uint64_t>(*back) == std::bit_cast<std::uint64_t>(value));
  }
}

TEST_CASE("The locale never matters") {
  const CommaLocale comma;
  CHECK(number_text(1234.5) == "1234.5");
  CHECK(fixed_text(1234.5, 2) == "1234.50");
  CHECK(grouped_text(1234567) == "1,234,567");
  CHECK(parse_number<double>("1234.5") == 1234.5);
  CHECK_FALSE(parse_number<double>("1234,5").has_value());
}

TEST_CASE("A number is the whole text or nothing") {
  CHECK(parse_number<double>("+2.5") == 2.5);
  CHECK_FALSE(parse_number<double>("+-2.5").has_value());
  CHECK(parse_number<double>("-1e-3") == -1e-3);
  CHECK(parse_number<int>("-12") == -12);
  for (const char* bad : {"", "+", "-", " 1", "1 ", "1\n", "1,5", "1.5.2", "0x10", "1e", "1e999",
                          "--1", "++1", "one"}) {
    CAPTURE(bad);
    CHECK_FALSE(parse_number<double>(bad).has_value());
  }
  for (const char* bad : {"1.0", "1e3", "2147483648", "-2147483649", ""}) {
    CAPTURE(bad);
    CHECK_FALSE(parse_number<int>(bad).has_value());
  }
  CHECK(parse_number<int>("2147483647") == std::numeric_limits<int>::max());
  CHECK_FALSE(parse_number<unsigned>("-1").has_value());
}

TEST_CASE("Texts are taken apart and put together") {
  using Pieces = std::vector<std::string_view>;
  CHECK(split_blanks(" a\tbc  d\r\n") == Pieces{"a", "bc", "d"});
  CHECK(split_blanks(" \t ").empty());
  CHECK(split("a::b:", ':') == Pieces{"a", "", "b", ""});
  CHECK(split("", ':') == Pieces{""});
  CHECK(join({"a", "b", "c"}) == "a, b, c");
  CHECK(join({"a", "b"}, "/") == "a/b");
  CHECK(join({}).empty());
}

TEST_CASE("The closest name is that with the fewest changes, if it is near") {
  CHECK(closest_name("erasr", {"dynamicmap", "erasor"}) == "erasor");   // 1 of 6 changes.
  CHECK(closest_name("tau", {"tau10", "tau1"}) == "tau1");              // 2 and 1.
  CHECK(closest_name("abc", {"abx", "xyz"}) == "abx");                  // 1 of 3: just near.
  CHECK_FALSE(closest_name("abcd", {"abxy", "wxyz"}).has_value());      // 2 of 4: too far.
  CHECK(closest_name("ERASOR", {"dynamicmap", "erasor"}) == "erasor");  // Case is no change.
  CHECK(closest_name("f1", {"PR", "F1"}) == "F1");
  CHECK(closest_name("voxel", {"percentile", "voxel_size"}) == "voxel_size");  // Part of it.
  CHECK_FALSE(closest_name("vo", {"voxel_size"}).has_value());  // Too short for a part.
  CHECK_FALSE(closest_name("x", {}).has_value());
  CHECK(closest_name("twon", {"highway", "town"}) == "town");    // A swap is 1 of 4 changes.
  CHECK(closest_name("raods", {"movers", "roads"}) == "roads");  // 1 of 5.
}

TEST_CASE("A suggestion names the near one, or all") {
  CHECK(suggestion("erasr", {"erasor", "dynamicmap"}) == " Did you mean 'erasor'?");
  CHECK(suggestion("zzz", {"erasor", "dynamicmap"}) == " Supported are: erasor, dynamicmap.");
}
