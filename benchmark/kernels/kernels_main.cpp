// SPDX-License-Identifier: MIT
// Google Benchmark programs; see scripts/benchmark.sh.
#include <benchmark/benchmark.h>

#include <cstdio>

#include "benchmark/kernels/workloads.h"

int main(int argc, char** argv) {
  using namespace raymoval;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    kernels_bench::register_image_kernels();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kernels: %s\n", error.what());
    return 2;
  }
  benchmark::Shutdown();
  return 0;
}
