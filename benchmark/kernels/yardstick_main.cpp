// SPDX-License-Identifier: MIT
// Prints the name of the yardstick and its time in milliseconds, the median of five, with a tab
// between: what scripts/record.sh relates the times of methods to.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include "benchmark/kernels/yardstick.h"

int main() {
  std::array<double, 5> milliseconds{};
  std::uint64_t made = 0;
  for (double& time : milliseconds) {
    const auto started = std::chrono::steady_clock::now();
    made |= raymoval::kernels_bench::run_yardstick();
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - started;
    time = taken.count();
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  std::printf("%s\t%.3f\n", raymoval::kernels_bench::kYardstick, milliseconds[2]);
  return made == 0 ? 3 : 0;
}
