// SPDX-License-Identifier: MIT
// Google Benchmark programs; see scripts/benchmark.sh. `raymoval_kernels --table FILE...` writes
// the medians of earlier runs as Markdown, and `--cells FILE [ROUNDS]` times
// whole cells.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>
#include <vector>

#include "benchmark/kernels/cell_times.h"
#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/table.h"
#include "core/error.h"
#include "core/text.h"

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

/// Times whole cells into a file, and prints their table.
/// @param words the file, and perhaps the number of rounds
int time_whole_cells(const std::vector<std::string>& words) {
  try {
    const auto rounds = raymoval::parse_number<int>(words.size() > 1 ? words[1] : "5");
    if (!rounds || *rounds < 1 || words.size() > 2) {
      throw raymoval::UsageError("usage: raymoval_kernels --cells FILE [ROUNDS]");
    }
    const raymoval::SpeedRecord speed = raymoval::kernels_bench::time_cells(*rounds);
    raymoval::write_speed(words[0], speed);
    std::fputs(raymoval::kernels_bench::cells_table(speed).c_str(), stdout);
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
  if (argc > 2 && std::string(argv[1]) == "--cells")
    return time_whole_cells({argv + 2, argv + argc});
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
