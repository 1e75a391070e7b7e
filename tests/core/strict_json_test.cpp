// SPDX-License-Identifier: MIT
#include "core/files/strict_json.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/error.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

std::string nested(int levels) {
  const auto count = static_cast<std::size_t>(levels);
  return std::string(count, '[') + std::string(count, ']');
}

}  // namespace

TEST_CASE("JSON with comments is read, and the order of keys can be kept") {
  const std::string text = "{ // first\n \"b\": 1, /* then */ \"a\": [1.5, null] }";
  CHECK(parse_json(text, "f").at("a").at(0) == 1.5);
  CHECK(parse_ordered_json(text, "f").dump() == R"({"b":1,"a":[1.5,null]})");
}

TEST_CASE("A slip is named with line and column") {
  // The closing brace in line 2 is at the place of a missing value.
  CHECK_THROWS_WITH(parse_json("{\n\"a\": }", "f.json"),
                    Contains("f.json: line 2, column 6: not valid JSON"));
}

TEST_CASE("A key that stands twice is refused, in one object only") {
  CHECK_THROWS_WITH(parse_json(R"({"a": 1, "b": {"a": 1}, "a": 2})", "f.json"),
                    Contains("f.json: the key \"a\" occurs twice"));
  CHECK_NOTHROW(parse_json(R"([{"a": 1}, {"a": {"a": 1}}])", "f.json"));
}

TEST_CASE("A number beyond double is refused") {
  CHECK_THROWS_AS(parse_json("[1e999]", "f.json"), ConfigurationError);
}

TEST_CASE("Levels are limited, so that nothing overflows the stack") {
  CHECK_NOTHROW(parse_json(nested(kMostJsonDepth), "f.json"));
  CHECK_THROWS_AS(parse_json(nested(kMostJsonDepth + 1), "f.json"), ConfigurationError);
  CHECK_THROWS_AS(parse_ordered_json(std::string(1'000'000, '['), "f.json"), ConfigurationError);
}

TEST_CASE("A text with a zero byte is no name, but a program may have printed it") {
  CHECK_THROWS_WITH(parse_json(R"({"path": "a\u0000b"})", "f.json"), Contains("zero byte"));
  CHECK(
      parse_ordered_json(R"({"output": "a\u0000b"})", "f").at("output").get<std::string>().size() ==
      3);
}
