// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace raymoval;

TEST_CASE("Each index is visited exactly once") {
  for (const int threads : {1, 2, 8}) {
    std::vector<std::atomic<int>> visits(10007);
    parallel_for(threads, visits.size(), 13, [&](std::size_t i) { ++visits[i]; });
    int wrong = 0;
    for (const auto& count : visits) wrong += count == 1 ? 0 : 1;
    CHECK(wrong == 0);
  }
}

TEST_CASE("Sums in chunk order have the same bits for any number of threads") {
  const auto sum = [](int threads) {
    std::vector<double> parts(101, 0.0);
    parallel_chunks(threads, 1001, 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) parts[begin / 10] += 1.0 / (1.0 + double(i));
    });
    double total = 0.0;
    for (const double part : parts) total += part;
    return total;
  };
  CHECK(sum(2) == sum(1));
  CHECK(sum(8) == sum(1));
}

TEST_CASE("The exception of the lowest chunk is thrown") {
  for (const int threads : {1, 2, 8}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      try {
        parallel_for(threads, 100, 1, [](std::size_t i) {
          if (i >= 17) throw std::runtime_error(std::to_string(i));
        });
        FAIL("nothing was thrown");
      } catch (const std::runtime_error& error) {
        REQUIRE(std::string(error.what()) == "17");
      }
    }
  }
}

TEST_CASE("A loop within a loop visits everything, on no more threads than were asked for") {
  for (const int threads : {1, 2, 3, 8}) {
    for (const int inner_threads : {1, 2, 8}) {
      std::vector<std::atomic<int>> visits(30 * 40);
      std::atomic<int> at_work = 0, most = 0;
      parallel_for(threads, 30, 1, [&](std::size_t outer) {
        parallel_for(inner_threads, 40, 3, [&](std::size_t inner) {
          const int now = ++at_work;
          int seen = most;
          while (seen < now && !most.compare_exchange_weak(seen, now)) {
          }
          ++visits[outer * 40 + inner];
          --at_work;
        });
      });
      int wrong = 0;
      for (const auto& count : visits) wrong += count == 1 ? 0 : 1;
      INFO(threads << " threads, " << inner_threads << " within");
      CHECK(wrong == 0);
      // Loops of different numbers of threads have threads of their own.
      if (inner_threads == 1 || inner_threads == threads) CHECK(most <= threads);
    }
  }
}

TEST_CASE("Whoever has done its part of a loop helps in a loop within another part") {
  // The two chunks of the inner loop wait for each other.
  if (hardware_threads() < 2) return;
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::atomic<int> arrived = 0;
    parallel_for(2, 2, 1, [&](std::size_t outer) {
      if (outer == 0) return;
      parallel_for(2, 2, 1, [&](std::size_t) {
        ++arrived;
        while (arrived < 2) std::this_thread::yield();
      });
    });
    CHECK(arrived == 2);
  }
}
