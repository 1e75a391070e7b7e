// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/result/results.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

using nlohmann::ordered_json;

/// A whole file of results around one cell.
ordered_json results_of(const ordered_json& cell) {
  ResultsRecord results;
  results.run.sequences = {{DataRecord{"street"}}};
  results.run.methods = {{"noop", "noop", "1"}};
  results.run.protocols = {{"erasor", "erasor", "1"}};
  ordered_json json = to_json(results);
  json["cells"].push_back(cell);
  return json;
}

/// The file unchanged, then its content with a valid checksum, as a cell and in results.
RAYMOVAL_FUZZ_TARGET(cell) {
  const auto path = input_file("cell.json", bytes);
  may_refuse([&] { (void)read_cell(path); });
  may_refuse([&] { (void)read_result_set(path); });
  const ordered_json cell = ordered_json::parse(bytes, nullptr, /*allow_exceptions=*/false);
  if (!cell.is_object() || bytes.size() > 100'000) return;
  may_refuse([&] {
    const auto results = input_file("results.json", "");
    write_sealed(results, results_of(cell));
    (void)shown_results(read_results(results));
    (void)read_result_set(results);
  });
}

}  // namespace
}  // namespace raymoval::fuzz
