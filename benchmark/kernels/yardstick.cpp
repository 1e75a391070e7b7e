// SPDX-License-Identifier: MIT
#include "benchmark/kernels/yardstick.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace raymoval::kernels_bench {
namespace {

/// Knuth's linear congruential generator.
std::uint64_t next(std::uint64_t& state) {
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return state >> 16;
}

std::uint64_t sort_keys() {
  std::uint64_t state = 1;
  std::vector<std::uint64_t> keys(500000);
  for (std::uint64_t& key : keys) key = next(state);
  std::sort(keys.begin(), keys.end());
  return keys[keys.size() / 3];
}

std::uint64_t gather_values() {
  std::vector<std::uint64_t> values(std::size_t{1} << 22);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i;
  std::uint64_t state = 2, sum = 0;
  for (int i = 0; i < 4000000; ++i) sum += values[next(state) & (values.size() - 1)];
  return sum;
}

std::uint64_t take_roots() {
  double root = 2.0;  // A chain of roots, so that wider instructions bring no gain.
  for (int i = 0; i < 8000000; ++i) root = std::sqrt(root) + 1.0;
  return static_cast<std::uint64_t>(root * 1e6);
}

}  // namespace

std::uint64_t run_yardstick() {
  return sort_keys() ^ gather_values() ^ take_roots();
}

}  // namespace raymoval::kernels_bench
