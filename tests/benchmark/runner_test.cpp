// SPDX-License-Identifier: MIT
#include "benchmark/runner.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/sealed_json.h"
#include "core/error.h"
#include "core/files.h"
#include "methods/controls/controls.h"
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
  Suite suite;
  SequenceOptions options;
  options.frames = parse_frame_range("0:1");
  suite.sequences.push_back({"street", options});
  for (const std::string& method : methods) add_method(suite, method, "", registry);
  add_protocol(suite, "erasor", "");
  add_controls(suite, registry);
  suite.threads = 1;
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
           {"odd", "failed", "no std::exception"},
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
  CHECK_THAT(csv, Contains("street,throws,v,erasor,failed,,,,,,,,,,throws:v"));
}

TEST_CASE("A cell that is there, right and whole is not run again; anything else is") {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "run";
  Suite suite = two_scans_with({"good"});
  const auto runs_of = [&](bool keep_removals) {
    toy_runs = 0;
    const RunSummary summary = run_suite(suite, {.out = out, .keep_removals = keep_removals});
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

  CHECK(runs_of(true) == 1);  // Removals are asked for and not there.
  CHECK(runs_of(true) == 0);
  const auto removals = out / "cells/street/good-v/removals/000001.label";
  std::filesystem::resize_file(removals, std::filesystem::file_size(removals) - 4);
  CHECK(runs_of(true) == 1);

  suite.sequences[0].options.frames = parse_frame_range("0:2");  // Other data.
  CHECK(runs_of(false) == 1);
  suite.protocols[0].options[0].second = 0.4;  // Another voxel size.
  CHECK(runs_of(false) == 1);
}

TEST_CASE("Two runs give the same bytes but for what is measured, whatever the threads") {
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
