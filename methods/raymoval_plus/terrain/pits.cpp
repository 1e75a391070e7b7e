// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/pits.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "methods/raymoval_plus/terrain/tiles.h"

namespace raymoval::raymoval_plus_method {
namespace {

constexpr std::size_t kAcross = 2 * kPitNeighbours + 1;
/// The lower quartile of the columns around is at most a height if so many are. There are at most
/// `kAcross` squared.
constexpr int kAlwaysEnough = static_cast<int>(kAcross * kAcross) / 4 + 1;
/// So many columns of a row are compared at a time.
constexpr std::size_t kColumnsAtOnce = 16;

/// The ground with columns without ground around it, which no loop has to ask for.
class PaddedGround {
 public:
  PaddedGround(const std::vector<float>& ground, std::size_t side)
      : stride_((side / kColumnsAtOnce + 1) * kColumnsAtOnce + 2 * kPitNeighbours),
        values_((side + 2 * kPitNeighbours) * stride_, kNoGround) {
    for (std::size_t y = 0; y < side; ++y) {
      std::copy_n(ground.data() + y * side, side,
                  values_.data() + (y + kPitNeighbours) * stride_ + kPitNeighbours);
    }
  }
  /// The lowest corner of the square around a column.
  [[nodiscard]] const float* around(std::size_t x, std::size_t y) const {
    return values_.data() + y * stride_ + x;
  }
  /// The column itself and those behind it.
  [[nodiscard]] const float* at(std::size_t x, std::size_t y) const {
    return around(x, y) + kPitNeighbours * stride_ + kPitNeighbours;
  }
  [[nodiscard]] std::size_t stride() const { return stride_; }

 private:
  std::size_t stride_;
  std::vector<float> values_;
};

using Counts = std::array<int, kColumnsAtOnce>;
using Heights = std::array<float, kColumnsAtOnce>;

/// Of each column, counts those around it in a row that are not above `highest`.
void count_not_above(const float* row, const Heights& highest, Counts& counts) {
  for (std::size_t aside = 0; aside < kAcross; ++aside) {
    for (std::size_t i = 0; i < kColumnsAtOnce; ++i) {
      counts[i] += row[i + aside] <= highest[i] ? 1 : 0;
    }
  }
}

/// Of each column, the number of those around it that have ground.
Counts count_ground(const float* corner, std::size_t stride) {
  std::array<int, kColumnsAtOnce + kAcross - 1> in_column{};
  for (std::size_t row = 0; row < kAcross; ++row) {
    for (std::size_t i = 0; i < in_column.size(); ++i) {
      in_column[i] += corner[row * stride + i] < kNoGround ? 1 : 0;
    }
  }
  Counts counts{};
  for (std::size_t aside = 0; aside < kAcross; ++aside) {
    for (std::size_t i = 0; i < kColumnsAtOnce; ++i) counts[i] += in_column[i + aside];
  }
  return counts;
}

/// Of each of some columns from (x, y) on, whether it has ground that is no pit.
std::array<bool, kColumnsAtOnce> are_no_pits(const PaddedGround& ground, std::size_t x,
                                             std::size_t y, float drop) {
  std::array<bool, kColumnsAtOnce> kept{};
  const float* const values = ground.at(x, y);
  // A column around may be as high as this; without ground it does not matter.
  Heights highest;
  Counts not_above;
  for (std::size_t i = 0; i < kColumnsAtOnce; ++i) {
    highest[i] = values[i] < kNoGround ? values[i] + drop : -kNoGround;
    not_above[i] = values[i] < kNoGround ? 0 : kAlwaysEnough;
  }
  const auto all_have_enough = [&] {
    return *std::min_element(not_above.begin(), not_above.end()) >= kAlwaysEnough;
  };
  // Rows from the middle outwards: on even ground three of them are enough.
  const float* const corner = ground.around(x, y);
  for (std::size_t step = 1; step <= kAcross && !all_have_enough(); ++step) {
    const std::size_t row = step % 2 == 0 ? kPitNeighbours - step / 2 : kPitNeighbours + step / 2;
    count_not_above(corner + row * ground.stride(), highest, not_above);
  }
  Counts around;
  around.fill(static_cast<int>(kAcross * kAcross));
  if (!all_have_enough()) around = count_ground(corner, ground.stride());
  for (std::size_t i = 0; i < kColumnsAtOnce; ++i) {
    kept[i] =
        values[i] < kNoGround && around[i] >= kLeastPitNeighbours && not_above[i] > around[i] / 4;
  }
  return kept;
}

}  // namespace

std::vector<float> without_pits(const std::vector<float>& ground, int side, float drop) {
  const auto columns = static_cast<std::size_t>(side);
  const PaddedGround padded(ground, columns);
  std::vector<float> kept(ground.size(), kNoGround);
  for (std::size_t y = 0; y < columns; ++y) {
    for (std::size_t x = 0; x < columns; x += kColumnsAtOnce) {
      const auto no_pit = are_no_pits(padded, x, y, drop);
      for (std::size_t i = 0; i < std::min(kColumnsAtOnce, columns - x); ++i) {
        if (no_pit[i]) kept[y * columns + x + i] = ground[y * columns + x + i];
      }
    }
  }
  return kept;
}

}  // namespace raymoval::raymoval_plus_method
