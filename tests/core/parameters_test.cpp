// SPDX-License-Identifier: MIT
#include "core/parameters.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

enum class Source { kNaive, kGrowing };

struct Parameters {
  double tau = 0.3;
  int bins = 720;
  bool erase = true;
  Source source = Source::kNaive;
};

const ParameterTable<Parameters>& table() {
  static const auto made =
      ParameterTable<Parameters>()
          .number("tau", &Parameters::tau,
                  {.unit = "m", .minimum = 0.0, .maximum = 1.0, .sentence = "How near."})
          .integer("bins", &Parameters::bins, {.minimum = 1, .maximum = 1000})
          .flag("erase", &Parameters::erase, {})
          .choice("source", &Parameters::source,
                  {{"naive", Source::kNaive}, {"growing", Source::kGrowing}}, {});
  return made;
}

ParameterValue from_json(const char* name, const json& value) {
  return checked_value("toy", find_parameter("toy", table().specs(), name), value);
}

ParameterValue from_text(const char* name, const char* text) {
  return checked_value_from_text("toy", find_parameter("toy", table().specs(), name), text);
}

}  // namespace

TEST_CASE("The table holds the defaults of the struct, in its order") {
  const Configuration defaults = table().write(Parameters{});
  REQUIRE(defaults.size() == 4);
  CHECK(to_json(defaults).dump() == R"({"tau":0.3,"bins":720,"erase":true,"source":"naive"})");
  CHECK(table().specs()[3].choices == std::vector<std::string>{"naive", "growing"});
  for (std::size_t i = 0; i < 4; ++i) CHECK(table().specs()[i].default_value == defaults[i].second);
}

TEST_CASE("JSON and text give the same values") {
  CHECK(from_json("tau", 0.5) == ParameterValue(0.5));
  CHECK(from_json("tau", 1) == ParameterValue(1.0));  // A whole number is a number.
  CHECK(from_json("bins", 10) == ParameterValue(std::int64_t{10}));
  CHECK(from_json("erase", false) == ParameterValue(false));
  CHECK(from_json("source", "growing") == ParameterValue(std::string("growing")));
  for (const auto& [name, value] : table().write({0.25, 7, false, Source::kGrowing})) {
    CHECK(from_text(name.c_str(), parameter_text(value).c_str()) == value);
  }
}

TEST_CASE("Both ends of a range are legal, and nothing beyond") {
  CHECK(from_json("tau", 0.0) == ParameterValue(0.0));
  CHECK(from_json("tau", 1.0) == ParameterValue(1.0));
  CHECK(from_text("bins", "1000") == ParameterValue(std::int64_t{1000}));
  CHECK_THROWS_AS(from_json("tau", -1e-9), ConfigurationError);
  CHECK_THROWS_AS(from_json("tau", 1.0000001), ConfigurationError);
  CHECK_THROWS_AS(from_json("bins", 0), ConfigurationError);
  CHECK_THROWS_AS(from_text("bins", "1001"), ConfigurationError);
  CHECK_THROWS_AS(from_text("tau", "nan"), ConfigurationError);
  CHECK_THROWS_AS(from_text("tau", "inf"), ConfigurationError);
  CHECK_THROWS_WITH(from_json("tau", 2.0), Contains("toy.tau = 2 is out of range") &&
                                               Contains("0 to 1 m") && Contains("How near."));
}

TEST_CASE("A value of the wrong type is an error that names the right one") {
  CHECK_THROWS_WITH(from_json("tau", "0.5"), Contains("toy.tau") && Contains("a number"));
  CHECK_THROWS_WITH(from_json("bins", 1.5), Contains("a whole number"));
  CHECK_THROWS_WITH(from_json("erase", 1), Contains("true or false"));
  CHECK_THROWS_WITH(from_json("source", 1), Contains("one of naive, growing"));
  CHECK_THROWS_AS(from_json("tau", nullptr), ConfigurationError);
  for (const char* bad : {"", "x", "0.5m", "0,5"}) {
    CHECK_THROWS_AS(from_text("tau", bad), ConfigurationError);
  }
  CHECK_THROWS_AS(from_text("bins", "1.0"), ConfigurationError);
  CHECK_THROWS_AS(from_text("erase", "yes"), ConfigurationError);
}

TEST_CASE("Unknown names and choices suggest the near ones") {
  CHECK_THROWS_WITH(from_json("tua", 1), Contains("toy has no parameter 'tua'"));
  CHECK_THROWS_WITH(from_json("bin", 1), Contains("Did you mean 'bins'?"));
  CHECK_THROWS_WITH(from_text("source", "naiv"), Contains("Did you mean 'naive'?"));
  CHECK_THROWS_WITH(find_parameter("noop", {}, "x"), Contains("noop has no parameters"));
}

TEST_CASE("Setting a parameter keeps the order, and one that is not there is our own fault") {
  Configuration configuration = table().write(Parameters{});
  set_parameter(configuration, "bins", std::int64_t{9});
  CHECK(table().read(configuration).bins == 9);
  CHECK(configuration[1].first == "bins");
  CHECK_THROWS_AS(set_parameter(configuration, "bin", std::int64_t{9}), InternalError);
}
