// SPDX-License-Identifier: MIT
#include "benchmark/suite/suite.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "eval/protocol_registry.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// The controls, and "toy" with variants a and b and the parameters size (1, from 0 to 10) and gap
/// (2), which acts on sizes above 1.
const MethodRegistry& toy_methods() {
  static const MethodRegistry registry = [] {
    MethodRegistry methods;
    methods.add(noop_entry());
    methods.add(remove_all_entry());
    methods.add(oracle_entry());
    MethodEntry toy = noop_entry();
    toy.name = "toy";
    toy.parameters = {{"size", 1.0, {.minimum = 0.0, .maximum = 10.0}, {}},
                      {"gap", 2.0, {.acts_when = "size > 1"}, {}}};
    toy.variants = {{"a", "", false, {}}, {"b", "", false, {{"gap", 3.0}}}};
    methods.add(toy);
    return methods;
  }();
  return registry;
}

double value(const Suite& suite, std::size_t method, const std::string& name) {
  for (const auto& [key, held] : suite.methods[method].method.configuration) {
    if (key == name) return std::get<double>(held);
  }
  return -1.0;
}

Suite suite_of(const std::string& json, const std::string& data = "") {
  const test::TemporaryFolder folder;
  write_atomically(folder.path() / "suite.json", json);
  return read_suite(folder.path() / "suite.json", toy_methods(), data);
}

Suite suite_with(const std::string& methods) {
  return suite_of(R"({"sequences": ["street"], "methods": [)" + methods + "]}");
}

Suite suite_on(const std::string& path, const std::string& data) {
  return suite_of(R"({"sequences": [")" + path + R"("], "methods": ["toy"]})", data);
}

}  // namespace

TEST_CASE("A setting is METHOD.key=value") {
  const Setting setting = parse_setting("toy:a.size=1.5");
  CHECK(setting.target == "toy:a");
  CHECK(setting.key == "size");
  CHECK(setting.value == "1.5");
  for (const char* bad : {"", "toy", "toy.size", "toy=1", ".size=1", "toy.=1", "=1.5"}) {
    CHECK_THROWS_AS(parse_setting(bad), UsageError);
  }
}

TEST_CASE("A setting of a method reaches all variants, and one of a variant wins in any order") {
  for (const bool method_first : {true, false}) {
    Suite suite;
    add_method(suite, "toy:a", "", toy_methods());
    add_method(suite, "toy:b", "", toy_methods());
    std::vector<Setting> settings = {{"toy", "size", "5"}, {"toy:b", "size", "6"}};
    if (!method_first) std::swap(settings[0], settings[1]);
    apply_settings(suite, settings);
    CHECK(value(suite, 0, "size") == 5.0);
    CHECK(value(suite, 1, "size") == 6.0);
    CHECK(value(suite, 1, "gap") == 3.0);  // The variant's own value stays.
  }
}

TEST_CASE("A setting reaches a protocol under its name in the suite") {
  Suite suite;
  add_method(suite, "toy:a", "", toy_methods());
  add_protocol(suite, "erasor", "");
  add_protocol(suite, "erasor", "fine");
  const Setting setting = parse_setting("protocol:fine.voxel_size=0.1");
  CHECK(setting.target == "protocol:fine");
  apply_settings(suite, {setting, {"toy", "size", "5"}});
  const auto voxel_size = [&](std::size_t i) {
    return std::get<double>(
        make_protocol("erasor", suite.protocols[i].options)->options()[0].second);
  };
  CHECK(voxel_size(0) == 0.2);
  CHECK(voxel_size(1) == 0.1);
  CHECK(value(suite, 0, "size") == 5.0);
  CHECK_THROWS_WITH(apply_settings(suite, {{"protocol:fin", "lift", "0"}}),
                    Contains("Did you mean 'fine'"));
  CHECK_THROWS_WITH(apply_settings(suite, {{"protocol:erasor", "lifd", "0"}}), Contains("'lift'"));
  CHECK_THROWS_WITH(apply_settings(suite, {{"erasor", "lift", "0"}}),
                    Contains("write protocol:erasor.key=value"));
}

TEST_CASE("Values of a method that do not fit together are refused before anything runs") {
  Suite suite;
  add_method(suite, "dynablox", "", MethodRegistry::built_in());
  CHECK_THROWS_AS(apply_settings(suite, {{"dynablox", "max_range", "0.1"}}), ConfigurationError);
  apply_settings(suite, {{"dynablox", "max_range", "30"}});
  CHECK(value(suite, 0, "max_range") == 30.0);
}

TEST_CASE("Settings that reach nothing, clash, or are illegal are errors") {
  Suite suite;
  add_method(suite, "toy:a", "", toy_methods());
  CHECK_THROWS_WITH(apply_settings(suite, {{"tow", "size", "1"}}), Contains("Did you mean 'toy'"));
  CHECK_THROWS_WITH(apply_settings(suite, {{"toy", "sise", "1"}}), Contains("'size'"));
  CHECK_THROWS_WITH(apply_settings(suite, {{"toy", "size", "11"}}), Contains("out of range"));
  CHECK_THROWS_WITH(apply_settings(suite, {{"toy", "size", "1"}, {"toy", "size", "1"}}),
                    Contains("twice"));
}

TEST_CASE("Two cells of one name clash, and controls come first and only once") {
  Suite suite;
  add_method(suite, "toy", "", toy_methods());
  CHECK_THROWS_AS(add_method(suite, "toy:a", "", toy_methods()), UsageError);
  CHECK_THROWS_AS(add_method(suite, "toy:b", "toy-a", toy_methods()),
                  UsageError);  // The same folder.
  add_method(suite, "oracle", "", toy_methods());
  add_controls(suite, toy_methods());
  std::vector<std::string> names;
  for (const MethodRequest& request : suite.methods) names.push_back(request.name);
  CHECK(names ==
        std::vector<std::string>{"noop:default", "remove-all:default", "toy:a", "oracle:default"});
}

TEST_CASE("A suite file says sequences, methods with values, protocols") {
  const Suite suite = suite_of(R"({
    // Comments are allowed.
    "name": "mine",
    "sequences": ["street", {"path": "street", "name": "short", "frames": "0:3",
                             "range_m": {"min": 1, "max": 50}}],
    "methods": ["toy:a", {"method": "toy:a", "set": {"size": 4}, "as": "big"}],
    "protocols": ["erasor", {"protocol": "erasor", "set": {"voxel_size": 0.4}, "as": "coarse"}],
    "controls": false, "threads": 3 })");
  CHECK(suite.name == "mine");
  REQUIRE(suite.sequences.size() == 2);
  CHECK(suite.sequences[0].path == "street");
  CHECK(suite.sequences[1].options.range_m->max == 50.0);
  REQUIRE(suite.methods.size() == 2);
  CHECK(suite.methods[1].name == "big");
  CHECK(value(suite, 1, "size") == 4.0);
  REQUIRE(suite.protocols.size() == 2);
  CHECK(suite.protocols[1].name == "coarse");
  CHECK_FALSE(suite.controls);
  CHECK(suite.threads == 3);
}

TEST_CASE("Every slip in a suite file is named with its place and the nearest legal word") {
  const auto with = [](const std::string& more) {
    return R"({"sequences": ["street"], "methods": ["toy:a"])" + more + "}";
  };
  CHECK_NOTHROW(suite_of(with("")));
  CHECK_THROWS_WITH(suite_of(with(R"(, "thread": 1)")), Contains("Did you mean 'threads'"));
  CHECK_THROWS_WITH(suite_of(with(R"(, "threads": 0)")), Contains("threads"));
  CHECK_THROWS_WITH(suite_of(with(R"(, "controls": 1)")), Contains("controls"));
  CHECK_THROWS_WITH(suite_of(with(R"(, "protocols": ["erasr"])")), Contains("erasor"));
  CHECK_THROWS_AS(suite_of("{}"), ConfigurationError);
  CHECK_THROWS_AS(suite_of("[]"), ConfigurationError);
  CHECK_THROWS_WITH(suite_of("{\n  \"name\": }"), Contains("line 2"));
  CHECK_THROWS_WITH(suite_of(R"({"sequences": [{"frames": "1:2"}], "methods": ["toy"]})"),
                    Contains("sequences[0]") && Contains("'path' is missing"));
  CHECK_THROWS_WITH(
      suite_of(R"({"sequences": ["street"], "methods": [{"method": "toy", "set": {"gab": 1}}]})"),
      Contains("methods[0]") && Contains("'gap'"));
  CHECK_THROWS_WITH(suite_of(R"({"sequences": ["street"], "methods": ["toy:c"]})"),
                    Contains("no variant 'c'"));
  CHECK_THROWS_AS(suite_of(R"({"sequences": ["street"], "methods": [7]})"), ConfigurationError);
}

TEST_CASE(
    "The word all is the default variant of each method but the controls, and NAME:all is all "
    "variants") {
  CHECK(expanded_methods("all", toy_methods()) == std::vector<std::string>{"toy:a"});
  CHECK(expanded_methods("toy:all", toy_methods()) == std::vector<std::string>{"toy:a", "toy:b"});
  CHECK(expanded_methods("toy", toy_methods()) == std::vector<std::string>{"toy"});
  CHECK_THROWS_WITH(expanded_methods("toi:all", toy_methods()), Contains("Did you mean 'toy'"));
  const Suite suite = suite_of(
      R"({"sequences": ["street"], "methods": ["noop", {"method": "toy:all", "set": {"size": 4}}]})");
  REQUIRE(suite.methods.size() == 3);
  CHECK(suite.methods[1].name == "toy:a*");
  CHECK(value(suite, 2, "size") == 4.0);
  CHECK_THROWS_WITH(
      suite_of(R"({"sequences": ["street"], "methods": [{"method": "toy:all", "as": "mine"}]})"),
      Contains("'as' names one method"));
  Suite one;
  CHECK_THROWS_WITH(add_method(one, "toy:all", "", toy_methods()),
                    Contains("stands for 2 methods") && Contains("toy:a, toy:b"));
}

TEST_CASE("A variant with a changed parameter has a '*' behind its name") {
  Suite suite = suite_with(
      R"("toy:a", {"method": "toy:a", "set": {"size": 4}}, {"method": "toy:b", "set": {"gap": 3}},
         {"method": "toy:b", "set": {"size": 4}, "as": "big"},
         {"method": "toy:b", "set": {"size": {"sweep": [2]}, "gap": 5}})");
  const auto names = [&] {
    std::vector<std::string> list;
    for (const MethodRequest& request : suite.methods) list.push_back(request.name);
    return list;
  };
  // The gap of b is 3 by its variant; a name of "as" stays.
  CHECK(names() == std::vector<std::string>{"toy:a", "toy:a*", "toy:b", "big", "toy:b*:size=2"});
  CHECK(suite.methods[4].sweep_of == "toy:b*");
  CHECK(suite.methods[4].changed_from() == Configuration{{"gap", 3.0}});
  CHECK(suite.methods[3].changed_from() == Configuration{{"size", 1.0}});
  CHECK(suite.methods[0].changed_from().empty());
  CHECK_THROWS_WITH(apply_settings(suite, {{"toy:a", "size", "4"}}),
                    Contains("two methods") && Contains("'toy:a*'"));
  suite.methods.resize(1);
  apply_settings(suite, {{"toy:a", "size", "4"}});
  CHECK(names() == std::vector<std::string>{"toy:a*"});
  apply_settings(suite, {{"toy:a", "size", "1"}});
  CHECK(names() == std::vector<std::string>{"toy:a"});
}

TEST_CASE("A sweep is a cell for each value") {
  const Suite suite =
      suite_with(R"({"method": "toy", "set": {"size": {"sweep": [1, 2.5]}}}, "toy")");
  REQUIRE(suite.methods.size() == 3);
  CHECK(suite.methods[0].name == "toy:a:size=1");
  CHECK(suite.methods[1].name == "toy:a:size=2.5");
  CHECK(suite.methods[1].sweep_of == "toy:a");
  CHECK(suite.methods[1].sweep == Configuration{{"size", 2.5}});
  CHECK(suite.methods[1].method.configuration == Configuration{{"size", 2.5}, {"gap", 2.0}});
  CHECK(suite.methods[2].name == "toy:a");
  CHECK(suite.methods[2].sweep.empty());
}

TEST_CASE("Two sweeps are combined, and plain values hold for all points") {
  const Suite suite = suite_with(
      R"({"method": "toy", "as": "t", "set": {"gap": {"sweep": [3, 4]}, "size": {"sweep": [1, 2]}}},
         {"method": "toy", "as": "u", "set": {"gap": 7, "size": {"sweep": [1]}}})");
  std::vector<std::string> names;
  for (const MethodRequest& request : suite.methods) names.push_back(request.name);
  CHECK(names == std::vector<std::string>{"t:gap=3,size=1", "t:gap=3,size=2", "t:gap=4,size=1",
                                          "t:gap=4,size=2", "u:size=1"});
  CHECK(suite.methods[4].method.configuration == Configuration{{"size", 1.0}, {"gap", 7.0}});
}

TEST_CASE("Slips in a sweep are named") {
  const auto sweep = [](const std::string& value) {
    return suite_with(R"({"method": "toy", "set": {"size": )" + value + "}}");
  };
  CHECK_THROWS_WITH(sweep(R"({"sweeps": [1]})"),
                    Contains("methods[0].set.size") && Contains("Did you mean 'sweep'"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": []})"), Contains("a list of values"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": 3})"), Contains("a list of values"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": [1, 11]})"), Contains("out of range"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": [1, 1.0]})"), Contains("two methods"));
  CHECK_THROWS_WITH(suite_with(R"({"method": "toy", "set": {"sise": {"sweep": [1]}}})"),
                    Contains("'size'"));
  std::string many = "0";
  for (int i = 1; i <= 1000; ++i) many += "," + std::to_string(i / 1000.0);
  CHECK_THROWS_WITH(sweep(R"({"sweep": [)" + many + "]}"), Contains("more than 1000"));
  Suite suite = sweep(R"({"sweep": [1, 2]})");
  CHECK_THROWS_WITH(apply_settings(suite, {{"toy", "size", "3"}}), Contains("sweeps"));
  CHECK_NOTHROW(apply_settings(suite, {{"toy", "gap", "3"}}));
}

TEST_CASE("{data} stands for the data's root") {
  CHECK(suite_on("{data}:kitti-05", "/kitti").sequences[0].path == "/kitti:kitti-05");
  CHECK(suite_on("{data}/av2", "/kth").sequences[0].path == "/kth/av2");
  CHECK_THROWS_WITH(suite_on("{data}:05", ""), Contains("--data ROOT"));
  CHECK_THROWS_WITH(suite_on("street", "/kitti"), Contains("--data is given"));
}
