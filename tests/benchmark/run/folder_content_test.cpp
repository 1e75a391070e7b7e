// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/folder_content.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "core/error.h"
#include "core/files/files.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;

namespace {

using Words = std::vector<std::string>;

SequenceRecord sequence_called(const std::string& name, const std::string& fingerprint = "") {
  SequenceRecord sequence{DataRecord{name, "files", "", "0:1:1", 2}};
  sequence.data.fingerprint = fingerprint;
  return sequence;
}

SuiteMethodRecord method_called(const std::string& name, const std::string& version = "1") {
  return {name, "comb:default", version, {{"size", 0.5}}, {}};
}

/// Sequences with methods, all of them run.
RunRecord run_of(const Words& sequences, const Words& methods) {
  RunRecord run{"suite"};
  for (const std::string& name : sequences) run.sequences.push_back(sequence_called(name));
  for (const std::string& name : methods) run.methods.push_back(method_called(name));
  run.protocols = {{"erasor", "erasor", "1", {{"voxel_size", 0.2}}}};
  run.cells = run.all_cells();
  return run;
}

Words titles_of(const std::vector<CellName>& cells) {
  Words titles;
  for (const CellName& cell : cells) titles.push_back(cell.title());
  return titles;
}

/// A cell of `run`, with its time.
Cell cell_of(const RunRecord& run, const CellName& name, double seconds = 1.0) {
  Cell cell{name.sequence, name.name, "key of " + name.title()};
  const SuiteMethodRecord* method = find_named(run.methods, name.name);
  cell.method = {"comb", "default", method->version, false, false, method->parameters};
  cell.data = find_named(run.sequences, name.sequence)->data;
  cell.scores = {Score{run.protocols[0]}};
  cell.masks = MaskRecord{"digest", 3};
  cell.measured.emplace().total_seconds = seconds;
  cell.measured->mean_seconds = seconds / 2;
  return cell;
}

}  // namespace

TEST_CASE("The record of a folder is there, absent, or refused with what is wrong with it") {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "run.json";
  CHECK_FALSE(present_record(folder.path()));
  write_run_record(file, run_of({"town"}, {"a"}));
  REQUIRE(present_record(folder.path()));
  CHECK(present_record(folder.path())->suite == "suite");

  ordered_json json = read_sealed(file);
  json["schema_version"] = 7;
  write_sealed(file, json);
  CHECK_THROWS_WITH(
      present_record(folder.path()),
      Contains("run.json: it is of another version of raymoval") && Contains("--overwrite"));
  json["schema_version"] = kSchemaVersion;
  json["suite"]["methods"] = 7;
  write_sealed(file, json);
  CHECK_THROWS_WITH(present_record(folder.path()), Contains("run.json: it is not the record of"));
  write_atomically(file, "{");
  CHECK_THROWS_WITH(present_record(folder.path()),
                    Contains("run.json: it is damaged, or was changed by hand"));
}

TEST_CASE("A run that is added to a folder leaves what the folder has, and is newer") {
  RunRecord present = run_of({"town", "highway"}, {"a", "b"});
  present.sequences[0].data.fingerprint = "f";
  present.controls = false;
  RunRecord asked = run_of({"town", "street"}, {"c", "b"});
  asked.suite = kUnnamedSuite;
  asked.controls = false;
  asked.methods[1].version = "2";
  asked.sequences[0].data.source = "newer";
  RunRecord merged = merged_run_record(present, asked);
  CHECK(merged.suite == "suite");
  CHECK(names_of(merged.sequences) == Words{"town", "highway", "street"});
  CHECK(names_of(merged.methods) == Words{"a", "b", "c"});
  CHECK(merged.methods[1].version == "2");
  CHECK(merged.sequences[0].data.source == "newer");
  CHECK(merged.sequences[0].data.fingerprint == "f");
  CHECK(merged.sequences[2].data.fingerprint.empty());
  CHECK_FALSE(merged.controls);
  // The others were not requested.
  CHECK(titles_of(merged.cells) == Words{"town / a", "town / b", "town / c", "highway / a",
                                         "highway / b", "street / b", "street / c"});
  asked.suite = "suite";
  asked.controls = true;
  CHECK(merged_run_record(present, asked).controls);
  CHECK(merged_run_record(asked, present).controls);
  // If the run has all cells of the folder, the order is the run's.
  merged = merged_run_record(run_of({"town"}, {"a", "b"}), run_of({"street", "town"}, {"b", "a"}));
  CHECK(names_of(merged.sequences) == Words{"street", "town"});
  CHECK(names_of(merged.methods) == Words{"b", "a"});
  RunRecord named = run_of({"town"}, {"a"});
  named.suite = "named";
  CHECK(merged_run_record(present, named).suite == "named");
}

TEST_CASE("Cells of earlier runs stay in the tables if they fit the others") {
  const test::TemporaryFolder folder;
  const CellStore store(folder.path());
  RunRecord record = run_of({"town", "highway"}, {"a", "b", "c"});
  record.sequences[1].data.fingerprint = "f";
  for (const CellName& name : record.cells) {
    if (name == CellName{"town", "c"}) continue;  // It was not run.
    store.keep(cell_of(record, name));
  }
  RunRecord asked = run_of({"town"}, {"a"});
  const EarlierCells earlier = read_earlier_cells(store, record, asked);
  REQUIRE(earlier.kept.size() == 4);
  CHECK(earlier.left_out.empty());
  CHECK(earlier.find({"town", "a"}) == nullptr);  // It was requested.
  CHECK(earlier.find({"town", "c"}) == nullptr);
  REQUIRE(earlier.find({"highway", "b"}) != nullptr);
  CHECK(earlier.find({"highway", "b"})->title() == "highway / b");
  CHECK(earlier.lines() ==
        Words{"kept of earlier runs on town: b", "kept of earlier runs on highway: a, b, c"});

  // Differences are reported: another version, other data, a protocol of another version, damage.
  Cell cell = cell_of(record, {"town", "b"});
  cell.method.version = "0";
  store.keep(cell);
  cell = cell_of(record, {"highway", "a"});
  cell.data->fingerprint = "g";
  store.keep(cell);
  cell = cell_of(record, {"highway", "b"});
  cell.scores[0].protocol.version = "0";
  store.keep(cell);
  write_atomically(store.folder({"highway", "c"}) / "cell.json", "{");
  const EarlierCells old = read_earlier_cells(store, record, asked);
  CHECK(old.kept.empty());
  CHECK(old.left_out == Words{"town / b: method version was \"0\", is \"1\"",
                              "highway / a: it was made on other data",
                              "highway / b: protocol erasor version was \"0\", is \"1\"",
                              "highway / c: its file is damaged"});
  CHECK(old.lines().at(1) ==
        "left out of the tables: highway / a: it was made on other data. Run it again to have it.");

  // A cell that failed has no scores that could differ; one without data nothing to compare.
  cell.fail(CellStatus::kFailed, "no idea");
  store.keep(cell);
  cell = cell_of(record, {"highway", "a"});
  cell.fail(CellStatus::kBadData, "torn");
  cell.data.reset();
  store.keep(cell);
  cell = cell_of(record, {"highway", "c"});
  cell.data.reset();
  store.keep(cell);
  CHECK(read_earlier_cells(store, record, asked).kept.size() == 3);
  // A fingerprint that is not known cannot differ.
  record.sequences[1].data.fingerprint.clear();
  cell = cell_of(record, {"highway", "a"});
  cell.data->fingerprint = "g";
  store.keep(cell);
  CHECK(read_earlier_cells(store, record, asked).find({"highway", "a"}) != nullptr);
  // A file under the name of one cell that holds another.
  cell = cell_of(record, {"town", "b"});
  cell.name = "nobody";
  write_cell(store.folder({"town", "b"}) / "cell.json", cell);
  CHECK(read_earlier_cells(store, record, asked).left_out.at(0) == "town / b: its file is damaged");
}
