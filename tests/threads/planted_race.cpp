// SPDX-License-Identifier: MIT
// A race between chunks of a parallel loop, and a loop without a race: with these,
// scripts/threads.sh checks that ThreadSanitizer finds the race, and does not report TBB's work as
// a race.
//
//   raymoval_planted_race none | between-chunks
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <iostream>
#include <numeric>
#include <string_view>
#include <thread>
#include <vector>

#include "core/parallel.h"

namespace {

/// Waits until a second chunk has begun, which is on another thread. Puts nothing in order.
void meet(std::atomic<int>& begun) {
  begun.fetch_add(1, std::memory_order_relaxed);
  while (begun.load(std::memory_order_relaxed) < 2) std::this_thread::yield();
}

/// Each chunk reads what was made before the loop and writes its own part, which is read after it.
int sum_without_race(int threads) {
  std::atomic<int> begun{0};
  std::vector<int> made(1000, 1), parts(100, 0);
  raymoval::parallel_chunks(threads, made.size(), 10, [&](std::size_t begin, std::size_t end) {
    meet(begun);
    for (std::size_t i = begin; i < end; ++i) parts[begin / 10] += made[i];
  });
  return std::accumulate(parts.begin(), parts.end(), 0);
}

int sum_with_race(int threads) {
  std::atomic<int> begun{0};
  int sum = 0;
  raymoval::parallel_for(threads, 100, 1, [&](std::size_t) {
    meet(begun);
    ++sum;
  });
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view which = argc > 1 ? argv[1] : "";
  if (which != "none" && which != "between-chunks") return 2;
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  int sum = 0;
  for (int i = 0; i < 20; ++i) sum += which == "none" ? sum_without_race(8) : sum_with_race(8);
  std::cout << sum << std::endl;
}
