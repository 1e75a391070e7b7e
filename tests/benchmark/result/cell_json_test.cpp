// SPDX-License-Identifier: MIT
// The files of results: bytes that are read and written again stay, and damage is named.
#include "benchmark/result/cell_json.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/checks/differences.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "core/files/files.h"
#include "tests/benchmark/result/full_cell.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;
using test::full_cell;
namespace fs = std::filesystem;

namespace {

std::string error_of(const ordered_json& cell) {
  const std::string file = "somewhere/cell.json";
  try {
    (void)read_as<Cell>(cell, file);
  } catch (const FieldError& error) {
    return error.what();
  }
  return "";
}

using Pointer = ordered_json::json_pointer;

/// Every field of every object below `json`, with the names of its members.
void collect_fields(const ordered_json& json, const Pointer& place, std::vector<Pointer>& places) {
  if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) collect_fields(json[i], place / i, places);
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    places.push_back(place / key);
    collect_fields(value, place / key, places);
  }
}

bool may_be_missing(const Pointer& place) {
  const std::string text = place.to_string();
  for (const char* part :
       {"/parameters/", "/options/", "/counts/", "/rates/", "/undefined", "/values/"}) {
    const bool is_named = text.find(part) != std::string::npos;
    const bool of_column =
        std::string(part) == "/values/" && place.back() != "recall" && place.back() != "residue";
    if (is_named && !of_column && place.back() != "undefined") return true;
  }
  static const std::vector<std::string> kOptional = {
      "schema_version",  "key",          "data",
      "columns",         "confidence",   "masks",
      "measured",        "sensor_basis", "up",
      "up_source",       "max",          "scan_period_s",
      "drop_ego",        "label_rule",   "fingerprint",
      "intervals",       "median",       "p90",
      "peak_memory_mib", "T_sensor",     "time_offset_s",
      "deskew",          "losses"};
  return std::find(kOptional.begin(), kOptional.end(), place.back()) != kOptional.end();
}

}  // namespace

TEST_CASE("The reference is read and written byte for byte", "[result]") {
  const fs::path file = fs::path(RAYMOVAL_SOURCE_DIR) / "results/reference/street/results.json";
  const test::TemporaryFolder folder;
  const ResultsRecord results = read_results(file);
  CHECK(results.cells.size() > 10);
  write_results(folder.path() / "results.json", results);
  CHECK(read_text(folder.path() / "results.json") == read_text(file));
}

TEST_CASE("A field that is missing or of another type is named with its file", "[result]") {
  const ordered_json whole = full_cell();
  REQUIRE(error_of(whole).empty());
  std::vector<Pointer> places;
  collect_fields(whole, Pointer(), places);
  CHECK(places.size() > 70);
  for (const Pointer& place : places) {
    if (place.back() == "schema_version") continue;  // Of whole files, see below.
    INFO(place.to_string());
    ordered_json mistyped = whole;
    mistyped[place] = ordered_json::array({ordered_json::array({ordered_json::array()})});
    CHECK_THAT(error_of(mistyped), Contains("somewhere/cell.json: ") && Contains(place.back()));
    ordered_json missing = whole;
    missing[place.parent_pointer()].erase(place.back());
    if (may_be_missing(place)) {
      CHECK(error_of(missing).empty());
    } else {
      CHECK_THAT(error_of(missing),
                 Contains("somewhere/cell.json: ") && Contains(place.back() + ": is missing"));
    }
  }
}

TEST_CASE("A file of another version, or a list of places that does not fit, is refused",
          "[result]") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "run.json";
  RunRecord run{"quick"};
  run.sequences = {{DataRecord{"town"}, SequenceRequest{"town", {}}}};
  write_run_record(file, run);
  CHECK(read_run_record(file).sequences.at(0).place.value().path == "town");
  ordered_json json = read_sealed(file);
  json["places"][0]["frames"] = "one:two";
  write_sealed(file, json);
  CHECK_THROWS_WITH(read_run_record(file), Contains("run.json") && Contains("places[0]"));
  json["places"] = {nullptr, nullptr};
  write_sealed(file, json);
  CHECK_THROWS_WITH(read_run_record(file), Contains("places"));
  json["schema_version"] = 2;
  write_sealed(file, json);
  CHECK_THROWS_AS(read_run_record(file), SchemaVersionError);
  CHECK_THROWS_WITH(read_run_record(file), Contains("schema version 2, expected 1"));
}

TEST_CASE("Other people's results have no name that would be more than a name", "[result]") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "results.json";
  const auto error_with = [&](const std::string& name, int place) {
    ResultsRecord results{RunRecord{"quick"}};
    const auto at = [&](int here) { return place == here ? name : std::string("town"); };
    results.run.suite = at(0);
    results.run.sequences = {{DataRecord{at(1)}, std::nullopt}};
    results.run.methods = {{at(2), at(3), "1", {}, SweepRecord{at(4), {}}}};
    results.run.protocols = {{at(5), at(6), "1", {}}};
    Cell cell{at(7), at(8), "", CellStatus::kOk, "", ""};
    cell.method = {at(9), at(10), "1", false, false, {}};
    results.cells = {cell};
    write_results(file, results);
    try {
      (void)read_results(file);
    } catch (const DataError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(error_with("=1", -1).empty());
  for (const std::string name : {"=1+1", "-x", "@a", " a", "../x", "\x1b[2J",
                                 "\xe2\x80\xae"
                                 "x",
                                 "a\nb"}) {
    for (int place = 0; place <= 10; ++place) {
      INFO(name << " at " << place);
      CHECK_THAT(error_with(name, place), Contains("the name "));
    }
  }
}
