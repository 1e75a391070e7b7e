// SPDX-License-Identifier: MIT
#include "core/parameter_condition.h"

#include <catch2/catch.hpp>

using namespace raymoval;

namespace {

const Configuration kValues = {{"on", true},
                               {"off", false},
                               {"count", std::int64_t{3}},
                               {"size", 0.5},
                               {"source", std::string("growing")}};

bool holds(const std::string& condition) {
  return condition_holds(condition, kValues);
}

}  // namespace

TEST_CASE("a condition compares values of parameters") {
  CHECK(holds(""));
  CHECK_FALSE(holds("never"));
  CHECK(holds("on is true"));
  CHECK_FALSE(holds("off is true"));
  CHECK(holds("source is not naive"));
  CHECK_FALSE(holds("source is naive"));
  CHECK(holds("count is 3"));
  CHECK(holds("size > 0"));
  CHECK_FALSE(holds("size > 0.5"));
  CHECK(holds("size >= 0.5"));
  CHECK(holds("count < 4"));
  CHECK_FALSE(holds("count <= 2"));
}

TEST_CASE("in a condition 'and' binds closer than 'or'") {
  CHECK(holds("on is true and size > 0"));
  CHECK_FALSE(holds("on is true and size > 1"));
  CHECK(holds("off is true and size > 1 or on is true"));
  CHECK(holds("on is true or off is true and size > 1"));
  CHECK_FALSE(holds("off is true or on is true and size > 1"));
}

TEST_CASE("a malformed condition is a fault of the table") {
  for (const char* condition : {"on", "on is", "onn is true", "on is true size > 0", "size > x",
                                "size ~ 1", "on > 1", "on is true and", "is true"}) {
    INFO(condition);
    CHECK_THROWS_AS(holds(condition), InternalError);
  }
}

TEST_CASE("parameters without effect are named with their condition") {
  const std::vector<ParameterSpec> specs = {{"off", false, {}, {}},
                                            {"depth", 1.0, {.acts_when = "off is true"}, {}},
                                            {"lazy", 1.0, {.acts_when = "never"}, {}}};
  const Configuration values = {{"off", false}, {"depth", 2.0}, {"lazy", 1.0}};
  CHECK(without_effect("m:v", specs, values, {"off", "depth", "lazy"}) ==
        std::vector<std::string>{"m:v.depth has no effect here: it acts when off is true.",
                                 "m:v.lazy has no effect here: it changes time or memory only."});
  CHECK(without_effect("m:v", specs, {{"off", true}, {"depth", 2.0}}, {"depth"}).empty());
  CHECK_THROWS_AS(without_effect("m:v", specs, values, {"dept"}), ConfigurationError);
}
