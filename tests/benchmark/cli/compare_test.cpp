// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/harness.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/runner.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/comb.h"
#include "tests/benchmark/small_suite.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using nlohmann::ordered_json;

namespace {

void run_comb(const std::filesystem::path& out, std::size_t step) {
  MethodRegistry methods;
  for (MethodEntry entry : {noop_entry(), remove_all_entry(), oracle_entry()}) methods.add(entry);
  MethodEntry comb = noop_entry();
  comb.name = "comb";
  comb.make = [step](const Configuration&) { return std::make_unique<test::Comb>(step); };
  methods.add(comb);
  Suite suite = test::small_suite("0:1");
  add_method(suite, "comb", "", methods);
  add_controls(suite, methods);
  run_suite(suite, {.out = out});
}

int compare(const std::filesystem::path& run, const std::filesystem::path& reference) {
  const std::string a = run.string(), b = reference.string();
  const char* arguments[] = {"raymoval", "compare", a.c_str(), b.c_str()};
  return run_command_line(4, arguments);
}

}  // namespace

TEST_CASE("A broken method is found by the exit code of compare") {
  const test::TemporaryFolder folder;
  const auto good = folder.path() / "good", broken = folder.path() / "broken";
  run_comb(good, 10);
  run_comb(broken, 3);  // Loses more of the static map.
  std::filesystem::create_directory(folder.path() / "reference");
  const auto reference = folder.path() / "reference/results.json";
  write_reference(good / "results.json", reference);
  CHECK(compare(good, reference) == 0);
  CHECK(compare(good, reference.parent_path()) == 0);
  CHECK(compare(broken, reference) == 1);
  CHECK(compare(broken / "results.json", good) == 1);
  CHECK(compare(folder.path() / "nowhere", reference) == 2);
}

TEST_CASE("A reference holds nothing that changes from run to run") {
  const test::TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    run_comb(folder.path() / name, 10);
    write_reference(folder.path() / name / "results.json",
                    folder.path() / (std::string(name) + ".json"));
  }
  const ordered_json reference = read_sealed(folder.path() / "a.json");
  CHECK(reference == read_sealed(folder.path() / "b.json"));
  CHECK(reference["run"]["machine"].is_null());
  CHECK(reference["cells"].size() == 4);
  CHECK_FALSE(read_result_set(folder.path() / "a.json").cells[0].seconds_per_scan.has_value());
  CHECK(read_result_set(folder.path() / "a/results.json").cells[0].seconds_per_scan.has_value());
}

TEST_CASE("One cell that differs in data, parameters or protocol is not comparable") {
  const test::TemporaryFolder folder;
  run_comb(folder.path() / "run", 10);
  const ordered_json whole = read_sealed(folder.path() / "run/results.json");
  const auto changed = [&](const ordered_json::json_pointer& place, const ordered_json& value) {
    ordered_json json = whole;
    json["cells"][3][place] = value;
    write_sealed(folder.path() / "changed.json", json);
    return compare(folder.path() / "changed.json", folder.path() / "run");
  };
  using Pointer = ordered_json::json_pointer;
  CHECK(changed(Pointer("/data/fingerprint"), "0") == 2);
  CHECK(changed(Pointer("/data/label_rule/moving"), ordered_json::array({252})) == 2);
  CHECK(changed(Pointer("/method/parameters/tau0"), 0.3) == 2);
  CHECK(changed(Pointer("/protocols/0/version"), "99") == 2);
  CHECK(changed(Pointer("/protocols/0/options/voxel_size"), 0.1) == 2);
  CHECK(changed(Pointer("/name"), "comb:other") == 2);
  CHECK(changed(Pointer("/protocols/0/counts/removed_points"), 0) == 1);
  CHECK(changed(Pointer("/status"), "failed") == 1);
  CHECK(changed(Pointer("/method/version"), "99") == 0);
  CHECK(changed(Pointer("/protocols/0/counts"), "none") == 2);
}

TEST_CASE("No reference is made of a run with failures") {
  const test::TemporaryFolder folder;
  run_comb(folder.path() / "run", 10);
  ordered_json json = read_sealed(folder.path() / "run/results.json");
  json["cells"][3]["status"] = "failed";
  write_sealed(folder.path() / "failed.json", json);
  CHECK_THROWS_AS(write_reference(folder.path() / "failed.json", folder.path() / "r.json"),
                  UsageError);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "r.json"));
}
