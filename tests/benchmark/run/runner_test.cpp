// SPDX-License-Identifier: MIT
#include "benchmark/run/runner.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/results.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/plan.h"
#include "benchmark/tables/run_summary.h"
#include "core/error.h"
#include "core/files/files.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/small_suite.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;

namespace {

std::atomic<int> toy_runs = 0;

/// Answers as `mode` says; counts how often it runs.
class Toy : public Remover {
 public:
  explicit Toy(std::string mode) : mode_(std::move(mode)) {}
  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    ++toy_runs;
    if (mode_ == "throws") throw std::runtime_error("no idea");
    if (mode_ == "odd") throw 7;
    if (mode_ == "bad_data") throw DataError("000001.bin: torn");
    if (mode_ == "memory") throw std::bad_alloc();
    context.check_cancelled();
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const Scan scan = scans.load(i);
      if (mode_ == "missing" && i == 1) continue;
      Mask mask(scan.size() + (mode_ == "size" ? 1 : 0), 0);
      for (std::size_t k = 0; k < scan.size(); k += 2) mask[k] = 1;
      sink.accept(i, mask);
      if (mode_ == "twice") sink.accept(i, mask);
    }
  }

 private:
  std::string mode_;
};

MethodRegistry registry_with(MethodEntry noop) {
  MethodRegistry methods;
  methods.add(std::move(noop));
  methods.add(remove_all_entry());
  methods.add(oracle_entry());
  MethodEntry toy = noop_entry();
  toy.name = "toy";
  toy.parameters = {{"size", 1.0, {}, {}}};
  toy.variants.clear();
  for (const char* mode :
       {"good", "throws", "odd", "bad_data", "memory", "missing", "size", "twice"}) {
    MethodEntry one = toy;
    one.name = mode;
    one.variants = {{"v", "", true, {}}};
    one.make = [mode](const Configuration&) { return std::make_unique<Toy>(mode); };
    methods.add(one);
  }
  return methods;
}

const MethodRegistry& toys() {
  static const MethodRegistry registry = registry_with(noop_entry());
  return registry;
}

Suite two_scans_with(const std::vector<std::string>& methods,
                     const MethodRegistry& registry = toys()) {
  Suite suite = test::small_suite("0:1");
  for (const std::string& method : methods) add_method(suite, method, "", registry);
  add_controls(suite, registry);
  return suite;
}

ordered_json cell_of(const std::filesystem::path& out, const std::string& name) {
  return read_sealed(out / "cells/street" / name / "cell.json");
}

}  // namespace

TEST_CASE("A method that fails is a cell with a reason, and the rest goes on") {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "run";
  const Suite suite =
      two_scans_with({"throws", "odd", "bad_data", "memory", "missing", "size", "twice", "good"});
  const RunSummary summary = run_suite(suite, {.out = out});
  CHECK(summary.cells == 11);
  CHECK(summary.failures.size() == 7);
  CHECK(summary.controls.empty());
  CHECK_FALSE(summary.good());
  for (const auto& [name, status, reason] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"throws", "failed", "no idea"},
           {"odd", "failed", "an exception of an unknown type"},
           {"bad_data", "bad_data", "torn"},
           {"memory", "out_of_memory", "memory"},
           {"missing", "failed", "no mask for scan 1"},
           {"size", "failed", "the mask has"},
           {"twice", "failed", "second time"}}) {
    const ordered_json cell = cell_of(out, name + "-v");
    CHECK(cell["status"] == status);
    CHECK_THAT(cell["reason"].get<std::string>(), Contains(reason));
    CHECK(cell["protocols"].empty());
  }
  CHECK(cell_of(out, "good-v")["status"] == "ok");
  // A row per cell, failed ones included, and the heading.
  const std::string csv = read_text(out / "results.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 12);
  CHECK_THAT(csv, Contains("street,throws,v,erasor,failed,,,,,,,,,,,,,,,throws:v"));
}

TEST_CASE("A cell that is there, right and whole is not run again, and anything else is",
          "[slow]") {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "run";
  Suite suite = two_scans_with({"good"});
  bool overwrite = false;
  const auto runs_of = [&](bool keep_removals) {
    toy_runs = 0;
    const RunSummary summary =
        run_suite(suite, {.out = out, .keep_removals = keep_removals, .overwrite = overwrite});
    CHECK(summary.good());
    return toy_runs.load();
  };
  const auto cell = out / "cells/street/good-v/cell.json";
  CHECK(runs_of(false) == 1);
  const std::string first = read_text(cell);
  CHECK(runs_of(false) == 0);
  CHECK(read_text(cell) == first);

  std::string changed = first;  // One digit of a count or rate.
  changed.replace(changed.find("\"ok\""), 4, "\"ox\"");
  write_atomically(cell, changed);
  CHECK(runs_of(false) == 1);
  write_atomically(cell, first.substr(0, first.size() / 2));
  CHECK(runs_of(false) == 1);
  std::filesystem::remove(cell);
  CHECK(runs_of(false) == 1);

  CHECK(runs_of(true) == 1);  // Removals are requested and missing.
  CHECK(runs_of(true) == 0);
  const auto removals = out / "cells/street/good-v/removals/000001.label";
  std::filesystem::resize_file(removals, std::filesystem::file_size(removals) - 4);
  CHECK(runs_of(true) == 1);

  overwrite = true;                                              // Else it is refused, see below.
  suite.sequences[0].options.frames = parse_frame_range("0:2");  // Other data.
  CHECK(runs_of(false) == 1);
  suite.protocols[0].options[0].second = 0.4;  // Another voxel size.
  CHECK(runs_of(false) == 1);
}

namespace {

Suite two_scans_called(const std::string& sequence, const std::string& method) {
  Suite suite = two_scans_with({method});
  suite.sequences[0].options.name = sequence;
  return suite;
}

/// "sequence/name" of each cell of results.json, controls left out.
std::vector<std::string> cells_in(const std::filesystem::path& out) {
  std::vector<std::string> names;
  const ordered_json results = read_sealed(out / "results.json");
  for (const ordered_json& cell : results["cells"]) {
    if (cell["method"]["control"].get<bool>()) continue;
    names.push_back(cell["sequence"].get<std::string>() + "/" + cell["name"].get<std::string>());
  }
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("A method or a sequence that is added to a run folder leaves the others in its tables") {
  const test::TemporaryFolder folder;
  const auto& out = folder.path();
  run_suite(two_scans_called("a", "good"), {.out = out});
  toy_runs = 0;
  const RunSummary added = run_suite(two_scans_called("a", "throws"), {.out = out});
  CHECK(toy_runs == 1);
  CHECK(added.cells == 4);
  CHECK(added.reused == 3);  // The controls.
  CHECK(added.earlier == 1);
  CHECK(cells_in(out) == Names{"a/good:v", "a/throws:v"});

  run_suite(two_scans_called("b", "good"), {.out = out});
  CHECK(cells_in(out) == Names{"a/good:v", "a/throws:v", "b/good:v"});
  CHECK_THAT(read_text(out / "table.md"), Contains("### a\n") && Contains("### b\n"));
  // A cell that was not requested is not missing.
  CHECK_FALSE(read_sealed(out / "results.json").contains("missing"));
  const ordered_json record = read_sealed(out / "run.json");
  CHECK(record["places"].size() == 2);
  CHECK(record["suite"]["sequences"][0]["fingerprint"] ==
        record["suite"]["sequences"][1]["fingerprint"]);

  // The same again is what the folder has already: nothing runs, and the bytes stay.
  const std::string before = read_text(out / "results.json");
  toy_runs = 0;
  run_suite(two_scans_called("b", "good"), {.out = out});
  CHECK(toy_runs == 0);
  CHECK(read_text(out / "results.json") == before);
}

TEST_CASE("A suite of another name is refused, and replaces what is there if that is asked for") {
  const test::TemporaryFolder folder;
  const auto& out = folder.path();
  Suite one = two_scans_called("a", "good");
  one.name = "one";
  run_suite(one, {.out = out});
  const std::string before = read_text(out / "run.json") + read_text(out / "results.json");

  Suite other = two_scans_called("b", "good");
  other.name = "other";
  CHECK_THROWS_WITH(run_suite(other, {.out = out}),
                    Contains("suite 'one' (1 sequence, 4 methods)") && Contains("suite 'other'") &&
                        Contains("--overwrite"));
  CHECK_THROWS_AS(run_one_cell(other, {.out = out}, "b/good:v"), UsageError);
  CHECK_THROWS_AS(run_suite(other, {.out = out, .collect = true}), UsageError);
  CHECK(read_text(out / "run.json") + read_text(out / "results.json") == before);
  CHECK_FALSE(std::filesystem::exists(out / "cells/b"));
  CHECK_THAT(plan_suite(other, {.out = out}).refused, Contains("suite 'one'"));

  // A named sequence and method are added to the suite.
  run_suite(two_scans_called("a", "odd"), {.out = out});
  CHECK(cells_in(out) == Names{"a/good:v", "a/odd:v"});
  CHECK(read_sealed(out / "run.json")["suite"]["name"] == "one");
  CHECK(plan_suite(one, {.out = out}).earlier.size() == 1);

  run_suite(other, {.out = out, .overwrite = true});
  CHECK(cells_in(out) == Names{"b/good:v"});
  run_suite(other, {.out = out});
  CHECK_THROWS_AS(run_suite(one, {.out = out}), UsageError);
}

TEST_CASE("Other data or protocols are refused where the folder has results of the same name",
          "[slow]") {
  const test::TemporaryFolder folder;
  const auto& out = folder.path();
  const Suite suite = two_scans_called("a", "good");
  run_suite(suite, {.out = out});
  const std::string before = read_text(out / "results.json");
  Suite frames = suite;
  frames.sequences[0].options.frames = parse_frame_range("1:2");
  Suite range = suite;
  range.sequences[0].options.range_m = RangeLimits{0.0, 20.0};
  Suite option = suite;
  option.protocols[0].options[0].second = 0.4;
  Suite protocol = suite;
  protocol.protocols.clear();
  add_protocol(protocol, "dynamicmap", "");
  for (const auto& [changed, reason] : std::vector<std::pair<Suite, std::string>>{
           {frames, R"(frames was "0:1:1", is "1:2:1")"},
           {range, "range_m max was null, is 20.0"},
           {option, "protocol erasor options voxel_size was 0.2, is 0.4"},
           {protocol, "scored by erasor, and this run by dynamicmap"}}) {
    CHECK_THROWS_WITH(run_suite(changed, {.out = out}), Contains(reason));
    CHECK_THROWS_WITH(run_one_cell(changed, {.out = out}, "a/good:v"), Contains(reason));
    CHECK(read_text(out / "results.json") == before);
  }
  run_suite(frames, {.out = out, .overwrite = true});
  CHECK(cells_in(out) == Names{"a/good:v"});
  CHECK_THROWS_AS(run_suite(suite, {.out = out}), UsageError);
}

TEST_CASE("A method with other parameters is run again, and no table mixes it with the old ones") {
  const test::TemporaryFolder folder;
  const auto& out = folder.path();
  Suite first = two_scans_called("a", "good");
  apply_settings(first, {{"good", "size", "2"}});
  run_suite(first, {.out = out});
  Suite changed = two_scans_called("b", "good");
  apply_settings(changed, {{"good", "size", "3"}});
  run_suite(changed, {.out = out});
  CHECK(cells_in(out) == Names{"b/good:v*"});
  const ordered_json missing = read_sealed(out / "results.json")["missing"];
  CHECK(missing == ordered_json{"a / good:v*"});
  CHECK_THAT(plan_suite(changed, {.out = out}).left_out.at(0),
             Contains("a / good:v*: parameter size was 2.0, is 3.0"));
  changed.sequences[0].options.name = "a";
  run_suite(changed, {.out = out});
  CHECK(cells_in(out) == Names{"a/good:v*", "b/good:v*"});
}

TEST_CASE("A method with a changed parameter stands beside its variant and says the difference") {
  const test::TemporaryFolder folder;
  const auto& out = folder.path();
  run_suite(two_scans_called("a", "good"), {.out = out});
  Suite changed = two_scans_called("a", "good");
  apply_settings(changed, {{"good", "size", "2"}});
  run_suite(changed, {.out = out});
  CHECK(cells_in(out) == Names{"a/good:v", "a/good:v*"});
  const RunResults results = shown_results(read_results(out / "results.json"));
  REQUIRE(results.changed.size() == 1);
  CHECK(results.changed[0].note() == "good:v*: size = 2.0 (default 1.0)");
  CHECK_THAT(read_text(out / "table.md"),
             Contains("| good:v\\* ") && Contains("good:v\\*: size = 2.0 (default 1.0)"));
  CHECK_THAT(read_text(out / "table.tex"), Contains("good:v*: size = 2.0 (default 1.0)"));
  CHECK_THAT(read_text(out / "results.csv"), Contains(",good:v*\n"));
  CHECK_THAT(run_summary(results, "out"), Contains("good:v*: size = 2.0 (default 1.0)\n"));
}

TEST_CASE("Names that would share a folder, and a record that is damaged, are refused") {
  const test::TemporaryFolder folder;
  const auto& out = folder.path();
  run_suite(two_scans_called("a:b", "good"), {.out = out});
  CHECK_THROWS_WITH(run_suite(two_scans_called("a-b", "good"), {.out = out}),
                    Contains("'a:b'") && Contains("'a-b'"));
  const std::string record = read_text(out / "run.json");
  write_atomically(out / "run.json", record.substr(0, record.size() / 2));
  CHECK_THROWS_WITH(run_suite(two_scans_called("a:b", "good"), {.out = out}),
                    Contains("run.json") && Contains("--overwrite"));
  toy_runs = 0;
  run_suite(two_scans_called("a:b", "good"), {.out = out, .overwrite = true});
  CHECK(toy_runs == 0);
  CHECK(read_text(out / "run.json") == record);
}

TEST_CASE("Two runs give the same bytes but for what is measured, whatever the threads", "[slow]") {
  const auto cell_with = [](int threads) {
    const test::TemporaryFolder folder;
    Suite suite = two_scans_with({"good"});
    suite.threads = threads;
    run_suite(suite, {.out = folder.path()});
    ordered_json cell = cell_of(folder.path(), "good-v");
    CHECK(cell["measured"]["seconds_per_scan"]["mean"].is_number());
    CHECK(cell["masks"]["removed"].get<int>() > 0);
    cell.erase("measured");
    return cell.dump();
  };
  const std::string one = cell_with(1);
  CHECK(cell_with(2) == one);
  CHECK(cell_with(8) == one);
}

TEST_CASE("Controls that are off are told") {
  MethodEntry broken = noop_entry();
  broken.make = [](const Configuration&) { return std::make_unique<Toy>("good"); };
  const MethodRegistry registry = registry_with(broken);
  const test::TemporaryFolder folder;
  const RunSummary summary =
      run_suite(two_scans_with({"good"}, registry), {.out = folder.path() / "run"});
  CHECK(summary.failures.empty());
  CHECK_FALSE(summary.good());
  REQUIRE_FALSE(summary.controls.empty());
  CHECK_THAT(summary.controls.front(), Contains("noop") && Contains("PR") && Contains("100"));
  CHECK_THAT(read_text(folder.path() / "run/table.md"), Contains("CONTROLS ARE OFF"));
}

TEST_CASE("A folder with other files is left alone") {
  const test::TemporaryFolder folder;
  write_atomically(folder.path() / "thesis.tex", "x");
  CHECK_THROWS_AS(run_suite(two_scans_with({"good"}), {.out = folder.path()}), UsageError);
  CHECK_THROWS_AS(run_suite(two_scans_with({"good"}), {.out = folder.path() / "thesis.tex"}),
                  DataError);
}

TEST_CASE("A cancelled run keeps finished cells and goes on later") {
  const test::TemporaryFolder folder;
  const std::atomic<bool> cancel = true;
  const Suite suite = two_scans_with({"good"});
  CHECK_THROWS_AS(run_suite(suite, {.out = folder.path(), .cancel = &cancel}), Cancelled);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "results.json"));
  CHECK(run_suite(suite, {.out = folder.path()}).good());
}

TEST_CASE("Nothing in a run folder names a path") {
  const test::TemporaryFolder folder;
  run_suite(two_scans_with({"good"}), {.out = folder.path()});
  for (const char* file : {"run.json", "results.json", "table.md", "results.csv"}) {
    CHECK_THAT(read_text(folder.path() / file), !Contains(folder.path().string()));
  }
}
