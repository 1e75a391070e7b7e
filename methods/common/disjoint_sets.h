// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace raymoval {

/// Disjoint sets. The root of a set is its lowest element, so that numbers do not depend on the
/// order of the joins.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t root(std::uint32_t element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = root(a), root_b = root(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }
  /// The number of each element's set. Numbers begin at 0, in the order of the sets' first
  /// elements.
  std::vector<int> numbers() {
    std::vector<int> number(parent_.size());
    int next = 0;
    for (std::uint32_t i = 0; i < parent_.size(); ++i) {
      const std::uint32_t found = root(i);
      number[i] = found == i ? next++ : number[found];
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace raymoval
