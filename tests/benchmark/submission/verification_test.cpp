// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>

#include "benchmark/harness.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/run/runner.h"
#include "benchmark/submission/submission.h"
#include "core/files/files.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/comb.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;

namespace {

MethodEntry comb_entry(const std::string& name, std::size_t step) {
  MethodEntry comb = noop_entry();
  comb.name = name;
  comb.make = [step](const Configuration&) { return std::make_unique<test::Comb>(step); };
  return comb;
}

/// A run of two combs on six scans of the street, whose masks are kept.
class CombRun {
 public:
  CombRun() {
    MethodRegistry methods;
    methods.add(comb_entry("fine", 100));
    methods.add(comb_entry("coarse", 3));
    Suite suite;
    SequenceOptions options;
    options.frames = parse_frame_range("0:5");
    suite.sequences.push_back({"street", options});
    for (const char* name : {"fine", "coarse"}) add_method(suite, name, "", methods);
    add_protocol(suite, "erasor", "");
    suite.controls = false;
    suite.threads = 1;
    run_suite(suite, {.out = folder_ / "run", .keep_removals = true});
  }
  [[nodiscard]] std::filesystem::path cell_folder() const {
    return folder_ / "run" / "cells" / "street" / "fine-default";
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  /// Hands in the cell of `fine` after `change`, sealed anew, so that only its content can tell.
  [[nodiscard]] int verify_changed(const std::function<void(Cell&)>& change) const {
    Cell cell = read_cell(cell_folder() / "cell.json");
    change(cell);
    std::filesystem::create_directories(path("theirs"));
    write_cell(path("theirs") + "/street.json", cell);
    return verify({path("theirs"), "--masks", (cell_folder() / "removals").string()});
  }
  [[nodiscard]] static int verify(std::vector<std::string> words) {
    words.insert(words.begin(), {"raymoval", "verify", "--quiet"});
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    return run_command_line(static_cast<int>(arguments.size()), arguments.data());
  }

 private:
  test::TemporaryFolder folder_;
};

std::int64_t& count(Cell& cell, const std::string& name) {
  for (auto& [known, value] : cell.scores.at(0).counts) {
    if (known == name) return value;
  }
  throw std::runtime_error("no count " + name);
}

/// The key that follows from what the cell says now, so that the key does not tell.
void renew_key(Cell& cell) {
  CellIdentity identity{cell.method, *cell.data, {}};
  for (const Score& score : cell.scores) identity.protocols.push_back(score.protocol);
  cell.key = cell_key(identity);
}

}  // namespace

TEST_CASE("A submission as it was run holds, and one that was changed does not", "[slow]") {
  const CombRun run;
  CHECK(run.verify_changed([](Cell&) {}) == 0);
  CHECK(run.verify_changed([](Cell& cell) { --count(cell, "remaining_dynamic"); }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { cell.scores[0].counts.pop_back(); }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { *cell.scores[0].rates.at(0).value += 0.001; }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { *cell.scores[0].intervals->rates[0].high += 1; }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { ++cell.columns->values.at(0).share.part; }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { cell.masks->digest[0] ^= 1; }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { ++cell.masks->removed; }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { cell.method.parameters.emplace_back("speed", 9.0); }) ==
        1);
  CHECK(run.verify_changed([](Cell& cell) { cell.method.version = "99"; }) == 1);
  CHECK(run.verify_changed([](Cell& cell) {
    cell.data->fingerprint[0] ^= 1;
    renew_key(cell);
  }) == 1);
}

TEST_CASE("A submission with figures that its masks do not score, or without some, does not hold") {
  const CombRun run;
  REQUIRE(run.verify_changed([](Cell&) {}) == 0);
  CHECK(run.verify_changed([](Cell& cell) {
    ColumnValue& recall = cell.columns->values.at(1);
    recall.name += "_";
    ++recall.share.part;
  }) == 1);
  CHECK(run.verify_changed([](Cell& cell) {
    cell.columns->values.push_back({"more", {1, 2}, ""});
  }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { cell.columns->values.pop_back(); }) == 1);
  CHECK(run.verify_changed([](Cell& cell) {
    cell.scores[0].rates.push_back({"F1_no_truck", 0.99});
  }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { cell.scores[0].rates.pop_back(); }) == 1);
  CHECK(run.verify_changed([](Cell& cell) { cell.scores[0].counts.emplace_back("more", 1); }) == 1);
}

TEST_CASE("A submission whose intervals were drawn otherwise does not hold") {
  const CombRun run;
  const auto drawn = [&](const std::function<void(Intervals&)>& change) {
    return run.verify_changed([&](Cell& cell) { change(*cell.scores[0].intervals); });
  };
  REQUIRE(drawn([](Intervals&) {}) == 0);
  CHECK(drawn([](Intervals& intervals) { intervals.options.level = 0.5; }) == 1);
  CHECK(drawn([](Intervals& intervals) { intervals.options.replicates = 999999; }) == 1);
  CHECK(drawn([](Intervals& intervals) { ++intervals.options.seed; }) == 1);
  CHECK(drawn([](Intervals& intervals) { ++intervals.block_scans; }) == 1);
  CHECK(drawn([](Intervals& intervals) { intervals.rates.pop_back(); }) == 1);
}

TEST_CASE("A submission whose masks were changed does not hold") {
  const CombRun run;
  const std::filesystem::path masks = run.cell_folder() / "removals";
  const std::filesystem::path first = *std::filesystem::directory_iterator(masks);
  std::string words = read_text(first);
  words[4] = static_cast<char>(words[4] == 9 ? 251 : 9);  // The second point: kept becomes removed.
  std::ofstream(first, std::ios::binary) << words;
  CHECK(run.verify_changed([](Cell&) {}) == 1);
}

TEST_CASE("A submission without data, masks, result or whole file cannot be checked") {
  const CombRun run;
  CHECK(run.verify_changed([](Cell& cell) { cell.fail(CellStatus::kTimeout, "slow"); }) == 2);
  CHECK(run.verify_changed([](Cell& cell) { cell.masks.reset(); }) == 2);
  CHECK(run.verify_changed([](Cell& cell) { cell.sequence = "elsewhere"; }) == 2);
  CHECK(run.verify_changed([](Cell& cell) {
    cell.scores[0].protocol.version = "0";
    renew_key(cell);
  }) == 2);
  CHECK(run.verify_changed([](Cell& cell) { cell.columns.reset(); }) == 2);
  CHECK(run.verify_changed([](Cell& cell) {
    cell.columns->version = "0";
    cell.columns->values.at(1).share.part = 4000;
  }) == 2);
  // The key of such a cell holds that version, so that it does not follow here.
  CHECK(run.verify_changed([](Cell& cell) {
    cell.columns->version = "0";
    cell.key[0] = cell.key[0] == '0' ? '1' : '0';
  }) == 2);
  CHECK(run.verify({run.path("nothing")}) == 2);
  CHECK(run.verify({run.path("theirs")}) == 2);  // No masks beside it.
  CHECK(run.verify({run.path("theirs"), "--masks", run.path("nothing")}) == 2);
  std::ofstream(run.path("theirs") + "/street.json", std::ios::app) << "x";
  CHECK(run.verify({run.path("theirs")}) == 2);
}

TEST_CASE("What holds no cell itself, but beside or below it, says where the cells are") {
  const CombRun run;
  const std::filesystem::path run_folder = run.path("run");
  const std::filesystem::path sequence = run.cell_folder().parent_path();
  CHECK_THROWS_WITH(read_submission(sequence, "", true),
                    Catch::Contains("such as " + (sequence / "coarse-default").string()));
  CHECK_THROWS_WITH(read_submission(run_folder.parent_path(), "", true),
                    Catch::Contains("such as " + run_folder.string()));
  CHECK_THROWS_WITH(read_submission(run_folder / "results.json", "", true),
                    Catch::Contains("expected the run folder " + run_folder.string()));
}

TEST_CASE("Only what holds is in the table", "[slow]") {
  const CombRun run;
  CHECK(run.verify_changed([](Cell& cell) { --count(cell, "remaining_dynamic"); }) == 1);
  const std::string table = run.path("table.md");
  CHECK(run.verify({run.path("run"), "--table", table}) == 0);
  CHECK_THAT(read_text(table), Catch::Contains("## street by protocol erasor"));
  CHECK_THAT(read_text(table), Catch::Contains("coarse:default"));
  // What was handed in finds its masks by its name; the run has its own.
  std::filesystem::create_directory(run.path("masks"));
  std::filesystem::copy(run.cell_folder() / "removals", run.path("masks") + "/theirs");
  const std::vector<std::string> both = {run.path("run"),   run.path("theirs"), "--masks",
                                         run.path("masks"), "--table",          table};
  CHECK(run.verify(both) == 1);
  CHECK_THAT(read_text(table), !Catch::Contains("theirs"));
  CHECK(run.verify_changed([](Cell&) {}) == 0);
  CHECK(run.verify(both) == 0);
  CHECK_THAT(read_text(table), Catch::Contains("theirs"));
}
