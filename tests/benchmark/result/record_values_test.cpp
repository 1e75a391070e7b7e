// SPDX-License-Identifier: MIT
// Values at the limits of a result file, and the messages for values beyond.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "core/files/files.h"
#include "core/name.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;

namespace {

ordered_json plain_cell() {
  Cell cell{"town", "comb", "key"};
  cell.method = {"comb", "default", "1", false, false, {}};
  cell.data = DataRecord{"town", "files"};
  cell.data->label_rule = LabelRule{"rule", {252}, {}};
  cell.masks = MaskRecord{"d", 7};
  cell.measured.emplace();
  return to_json(cell);
}

/// The message for a cell with `value` at `place`; empty if it is read.
std::string said_of(const char* place, const ordered_json& value) {
  ordered_json json = plain_cell();
  json[ordered_json::json_pointer(place)] = value;
  try {
    (void)read_as<Cell>(json, "cell.json");
  } catch (const FieldError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("What is wrong with a name or a place is told with its field", "[result]") {
  CHECK(said_of("/method/name", "=1") ==
        "cell.json: not the results of a run (method.name: the name begins with '='; expected " +
            std::string(kNameForm) + "). Run `raymoval run` again with the same --out.");
  ordered_json run = to_json(RunRecord{"quick"});
  run["suite"]["sequences"].push_back(plain_cell()["data"]);
  run["places"] = ordered_json::parse(R"([{"path": "town", "frames": "one"}])");
  CHECK_THROWS_WITH(read_as<RunRecord>(run, "run.json"),
                    Contains("run.json: not the results of a run (places[0]: frame range 'one'"));
  // Two numbers are a list of them.
  Cell cell = read_as<Cell>(plain_cell(), "cell.json");
  cell.scores = {Score{{"erasor", "erasor", "1", {}}}};
  cell.scores[0].intervals.emplace().rates = {{"PR", 1.0, 2.0}};
  ordered_json json = to_json(cell);
  json["protocols"][0]["intervals"]["rates"]["PR"] = {{"low", 1.0}, {"high", 2.0}};
  CHECK_THROWS_WITH(read_as<Cell>(json, "cell.json"), Contains("rates.PR: expected two numbers"));
}

TEST_CASE("Parameters keep their types, and what is no number any more stays none", "[result]") {
  ordered_json json = plain_cell();
  json["method"]["parameters"] = {
      {"flag", true}, {"count", 3}, {"size", 3.0}, {"text", "3"}, {"infinite", nullptr}};
  const Configuration values = read_as<Cell>(json, "cell.json").method.parameters;
  REQUIRE(values.size() == 5);
  CHECK(std::get<bool>(values[0].second));
  CHECK(std::get<std::int64_t>(values[1].second) == 3);
  CHECK(std::get<double>(values[2].second) == 3.0);
  CHECK(std::get<std::string>(values[3].second) == "3");
  CHECK(std::isnan(std::get<double>(values[4].second)));
  CHECK(value_text(values[2].second) == "3.0");
  CHECK(value_text(std::string("a\xff")) == "\"a\xef\xbf\xbd\"");
}

TEST_CASE("A cell that fails loses its scores, and says why", "[result]") {
  Cell cell = read_as<Cell>(plain_cell(), "cell.json");
  Score score;
  score.rates = {{"PR", 90.0}, {"RR", {}, "nothing moves"}};
  CHECK(score.rate("PR") == 90.0);
  CHECK_FALSE(score.rate("RR"));
  CHECK_FALSE(score.rate("F1"));
  cell.scores = {score};
  cell.columns = ColumnRecord{"1", {}};
  CHECK(cell.ok());
  cell.fail(CellStatus::kOutOfMemory, "too large");
  CHECK_FALSE(cell.ok());
  CHECK(cell.reason == "too large");
  CHECK(cell.scores.empty());
  CHECK_FALSE(cell.columns);
  CHECK(cell.title() == "town / comb");
}

TEST_CASE("A sealed file is whole and unchanged, or it is refused with what to do", "[result]") {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  write_sealed(file, {{"checksum", "of before"}, {"count", 3}, {"text", "a\xff"}});
  const ordered_json json = read_sealed(file);
  CHECK(json == ordered_json{{"count", 3}, {"text", "a\xef\xbf\xbd"}});
  CHECK(json_text(json) == "{\n  \"count\": 3,\n  \"text\": \"a\xef\xbf\xbd\"\n}\n");
  // The checksum is that of the short text, so that other versions find the same.
  write_sealed(file, {{"text", "\xC3\x9F"}});
  CHECK(ordered_json::parse(read_text(file))["checksum"] ==
        content_hash("{\"text\":\"\xC3\x9F\"}"));
  for (const char* text : {"[1]", "{", "7", "{\"count\": 3}", "{\"checksum\": 3}"}) {
    write_atomically(file, text);
    CHECK_THROWS_WITH(read_sealed(file), Contains("a.json: not a whole result file of raymoval") &&
                                             Contains("Run `raymoval run` again"));
  }
  write_sealed(file, {{"count", 3}});
  std::string text = read_text(file);
  text.replace(text.find("3"), 1, "4");
  write_atomically(file, text);
  CHECK_THROWS_WITH(read_sealed(file), Contains("a.json: the content does not fit its checksum") &&
                                           Contains("Run `raymoval run` again"));
  CHECK_THROWS_AS(read_sealed(folder.path() / "none.json"), DataError);
}
