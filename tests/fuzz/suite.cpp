// SPDX-License-Identifier: MIT
#include "benchmark/suite/suite.h"

#include <nlohmann/json.hpp>

#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_suite(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const auto path = fuzz::input_file("suite.json", bytes);
    Suite suite = read_suite(path, MethodRegistry::built_in());
    fuzz::require(!suite.sequences.empty() && !suite.methods.empty(), "a suite is empty");
    add_controls(suite, MethodRegistry::built_in());
    for (const MethodRequest& request : suite.methods) {
      fuzz::require(folder_name(request.name).find('/') == std::string::npos,
                    "a cell's folder has a slash");
      (void)to_json(request.method.configuration).dump();
    }
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(suite, try_suite)
