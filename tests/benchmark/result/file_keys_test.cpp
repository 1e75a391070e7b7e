// SPDX-License-Identifier: MIT
// The keys of every result file, in their order: a file that lacks one, or has one more, is found.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "core/files/files.h"
#include "tests/benchmark/result/full_cell.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using nlohmann::ordered_json;

namespace {

// No value is the default of a record.

const char* const kData = R"({
  "name": "town", "layout": "files", "source": "here", "frames": "0:1:1", "scans": 2,
  "poses": "poses.txt", "sensor": "hdl64e", "sensor_basis": "two scans", "up": "z",
  "up_source": "given", "scan_period_s": 0.25, "range_m": {"min": 1.5, "max": 50.0},
  "drop_ego": {"asked": "auto", "left_out": "none"},
  "label_rule": {"name": "rule", "moving": [252], "ignored": [1]}, "T_sensor": "mount.txt",
  "time_offset_s": 0.5, "deskew": "t in seconds", "losses": ["cut"], "fingerprint": "f"})";
const char* const kMethod = R"({
  "name": "comb", "variant": "default", "version": "3", "online": true, "control": true,
  "parameters": {"size": 0.5}})";
const char* const kProtocol = R"({
  "name": "coarse", "protocol": "erasor", "version": "2", "options": {"voxel_size": 0.4}})";
const char* const kResult = R"({
  "counts": {"points": 3}, "rates": {"PR": 90.5, "RR": null}, "undefined": {"RR": "nothing moves"},
  "warnings": ["few points"],
  "intervals": {"level": 0.9, "replicates": 99, "seed": 7, "block_scans": 4,
    "rates": {"PR": [80.0, 95.0], "RR": null}, "undefined": {"RR": "nothing moves"}}})";
const char* const kColumns = R"({
  "version": "6",
  "values": {"recall": {"part": 1, "whole": 4, "percent": 25.0},
             "residue": {"part": 0, "whole": 0, "percent": null, "undefined": "nothing kept"}}})";
const char* const kMeasured = R"({
  "threads": 3,
  "seconds_per_scan": {"mean": 0.5, "median": 0.25, "p90": 0.75},
  "seconds_total": 8.5, "seconds_load": 1.25, "stages": [{"name": "cast", "seconds": 0.375}],
  "peak_memory_mib": 90.5})";
const char* const kBuild = R"({
  "version": "0.9", "commit": "abc", "source_tree": "clean", "compiler": "g++",
  "build_type": "Release"})";
const char* const kMachine = R"({
  "processor": "one", "cores": 4, "memory_gib": 16, "threads": 3})";

ordered_json parsed(const char* text) {
  return ordered_json::parse(text);
}

/// `first` with the keys of `second` behind its own.
ordered_json joined(ordered_json first, const ordered_json& second) {
  for (const auto& [key, value] : second.items()) first[key] = value;
  return first;
}

ordered_json whole_cell() {
  return {{"schema_version", 1},
          {"sequence", "town"},
          {"name", "comb:default"},
          {"key", "k"},
          {"status", "timeout"},
          {"reason", "too slow"},
          {"output_tail", "the end"},
          {"method", parsed(kMethod)},
          {"data", parsed(kData)},
          {"protocols", ordered_json::array({joined(parsed(kProtocol), parsed(kResult))})},
          {"columns", parsed(kColumns)},
          {"masks", {{"digest", "d"}, {"removed", 7}}},
          {"measured", parsed(kMeasured)}};
}

ordered_json whole_suite() {
  const ordered_json bare = parsed(R"({
    "name": "bare", "layout": "", "source": "", "frames": "", "scans": 0, "poses": "",
    "sensor": "", "scan_period_s": null, "range_m": {"min": 0.0, "max": null},
    "label_rule": null})");
  const ordered_json large = parsed(R"({
    "name": "large", "method": "comb:default", "version": "3", "parameters": {"size": 0.5},
    "sweep": {"of": "comb", "values": {"size": 0.5}}})");
  const ordered_json plain = parsed(R"({
    "name": "plain", "method": "comb:online", "version": "4", "parameters": {}})");
  return {{"name", "quick"},
          {"sequences", ordered_json::array({parsed(kData), bare})},
          {"methods", ordered_json::array({large, plain})},
          {"protocols", ordered_json::array({parsed(kProtocol)})},
          {"controls", false}};
}

/// What run.json and the part "run" of results.json have in common.
ordered_json run_part() {
  return {{"schema_version", 1},
          {"suite", whole_suite()},
          {"build", parsed(kBuild)},
          {"machine", parsed(kMachine)}};
}

ordered_json whole_run() {
  const ordered_json place = parsed(R"({
    "path": "/data/town", "frames": "0:1:1", "poses": "p.txt", "label_rule": "rule.json",
    "sensor": "hdl64e", "up": "z", "drop_ego": "auto", "name": "town", "range_min": "1.5",
    "range_max": "50"})");
  return {{"schema_version", 1},
          {"suite", whole_suite()},
          {"cells", parsed(R"([{"sequence": "town", "name": "large"}])")},
          {"build", parsed(kBuild)},
          {"machine", parsed(kMachine)},
          {"places", ordered_json::array({place, nullptr})}};
}

ordered_json whole_results() {
  return {{"schema_version", 1},
          {"run", run_part()},
          {"controls", parsed(R"({"checked": false, "problems": ["a"]})")},
          {"missing", parsed(R"(["town / plain"])")},
          {"cells", ordered_json::array({whole_cell(), test::full_cell()})}};
}

/// Draws new values of a file, and its optional parts.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  void values(ordered_json& json, const std::string& key = "") {
    static const std::set<std::string> kFixed = {
        "schema_version", "status", "places",  "part", "whole",  "percent", "confidence",
        "sequence",       "name",   "variant", "of",   "method", "protocol"};
    if (kFixed.contains(key) && !(json.is_object() && key == "method")) return;
    if (json.is_object()) parts(json);
    if (json.is_structured()) {
      for (auto item = json.begin(); item != json.end(); ++item) {
        values(*item, json.is_object() ? item.key() : "");
      }
    }
    if (json.is_boolean()) json = below(2) == 0;
    if (json.is_number_integer()) json = below(60000);
    if (json.is_number_float()) json = number();
    if (json.is_string()) json = text();
  }

 private:
  int below(int end) { return std::uniform_int_distribution(0, end - 1)(random_); }
  /// Any finite number, also a negative zero or one with an exponent.
  double number() {
    const double digits = std::uniform_real_distribution(-1.0, 1.0)(random_);
    return below(9) == 0 ? -0.0 : std::ldexp(digits, below(1900) - 1000);
  }
  std::string text() {
    static const char* const kPieces[] = {"town",     " ", "\"",  "\\", "\n",
                                          "\xC3\x9F", ":", "0.5", "/"};
    std::string text = kPieces[below(9)];
    for (int i = below(4); i > 0; --i) text += kPieces[below(9)];
    return text;
  }
  /// Leaves out what may be missing, and makes null or empty what may be that.
  void parts(ordered_json& json) {
    for (const char* key :
         {"drop_ego", "T_sensor", "time_offset_s", "deskew", "fingerprint", "sensor_basis", "up",
          "up_source", "intervals", "sweep", "confidence", "commit", "source_tree", "missing"}) {
      if (json.contains(key) && below(2) == 0) json.erase(key);
    }
    for (const char* key :
         {"scan_period_s", "label_rule", "data", "columns", "masks", "measured", "median", "p90",
          "peak_memory_mib", "memory_gib", "build", "machine", "max"}) {
      if (json.contains(key) && below(3) == 0) json[key] = nullptr;
    }
    for (const char* key : {"warnings", "stages", "moving", "ignored", "problems", "cells"}) {
      if (json.contains(key) && below(3) == 0) json[key] = ordered_json::array();
    }
    for (const char* key : {"parameters", "options", "counts"}) {
      if (json.contains(key) && below(3) == 0) json[key] = ordered_json::object();
    }
  }

  std::mt19937_64 random_;
};

}  // namespace

TEST_CASE("Files with any values have the same bytes after they were read", "[result]") {
  for (unsigned seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    for (ordered_json cell : {whole_cell(), test::full_cell()}) {
      draw.values(cell);
      CHECK(to_json(read_as<Cell>(cell, "cell.json")).dump() == cell.dump());
    }
    ordered_json run = whole_run(), results = whole_results();
    draw.values(run);
    CHECK(to_json(read_as<RunRecord>(run, "run.json")).dump() == run.dump());
    draw.values(results);
    CHECK(to_json(read_as<ResultsRecord>(results, "results.json")).dump() == results.dump());
  }
}

TEST_CASE("A cell's key is the hash of all that its counts depend on", "[result]") {
  const Cell cell = read_as<Cell>(whole_cell(), "cell.json");
  const ordered_json versions = {{"version", kColumnsVersion}};
  ordered_json whole = {{"schema_version", 1},
                        {"method", parsed(kMethod)},
                        {"data", parsed(kData)},
                        {"columns", versions},
                        {"protocols", ordered_json::array({parsed(kProtocol)})}};
  CellIdentity identity{cell.method, *cell.data, {cell.scores.at(0).protocol}};
  CHECK(cell_key(identity) == content_hash(json_text(whole)));
  identity.protocols.clear();
  whole.erase("protocols");
  CHECK(cell_key(identity) == content_hash(json_text(whole)));
}
