// SPDX-License-Identifier: MIT
// Google Benchmark programs; see scripts/benchmark.sh. `raymoval_kernels --table FILE...` writes
// the medians of earlier runs as Markdown.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>
#include <vector>

#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/table.h"

namespace {

int print_tables(const std::vector<std::string>& files) {
  try {
    std::fputs(raymoval::kernels_bench::tables_of(files).c_str(), stdout);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kernels: %s\n", error.what());
    return 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace raymoval;
  if (argc > 1 && std::string(argv[1]) == "--table") return print_tables({argv + 2, argv + argc});
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    kernels_bench::register_image_kernels();
    kernels_bench::register_map_kernels();
    kernels_bench::register_scan_kernels();
    kernels_bench::register_method_kernels();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kernels: %s\n", error.what());
    return 2;
  }
  benchmark::Shutdown();
  return 0;
}
