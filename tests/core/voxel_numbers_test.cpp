// SPDX-License-Identifier: MIT
#include "core/scan/voxel_numbers.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>

using namespace raymoval;

TEST_CASE("voxels are numbered in the order in which they come, and found again") {
  // Ten thousand keys of a small cube come thirty thousand times, so that the table grows often and
  // many keys are beside each other.
  std::mt19937 random(7);
  std::uniform_int_distribution<int> place(-12, 11);
  VoxelNumbers numbers;
  std::vector<VoxelKey> keys;
  const auto key_of = [&](VoxelNumbers::Number number) { return keys[number]; };
  std::map<VoxelKey, VoxelNumbers::Number> expected;
  CHECK(numbers.find(voxel_key(0, 0, 0), key_of) == VoxelNumbers::kNone);
  for (int i = 0; i < 30000; ++i) {
    const VoxelKey key = voxel_key(place(random), place(random), place(random));
    const auto known = expected.find(key);
    REQUIRE(numbers.find(key, key_of) ==
            (known == expected.end() ? VoxelNumbers::kNone : known->second));
    const auto number = numbers.add(key, key_of);
    if (known == expected.end()) {
      REQUIRE(number == keys.size());
      expected.emplace(key, number);
      keys.push_back(key);
    } else {
      REQUIRE(number == known->second);
    }
    REQUIRE(numbers.size() == keys.size());
  }
  CHECK(keys.size() > 5000);
  CHECK(numbers.find(voxel_key(100, 0, 0), key_of) == VoxelNumbers::kNone);
}

TEST_CASE("numbered voxels are forgotten, and room for them is made at once") {
  std::vector<VoxelKey> keys;
  const auto key_of = [&](VoxelNumbers::Number number) { return keys[number]; };
  VoxelNumbers numbers;
  for (int round = 0; round < 2; ++round) {
    numbers.reserve(3000, key_of);
    for (int x = 0; x < 3000; ++x) {
      CHECK(numbers.add(voxel_key(x, round, 0), key_of) == keys.size());
      keys.push_back(voxel_key(x, round, 0));
    }
    CHECK(numbers.find(voxel_key(2999, round, 0), key_of) == 2999);
    numbers.clear();
    CHECK(numbers.size() == 0);
    CHECK(numbers.find(voxel_key(2999, round, 0), key_of) == VoxelNumbers::kNone);
    keys.clear();
  }
}
