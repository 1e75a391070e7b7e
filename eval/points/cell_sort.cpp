// SPDX-License-Identifier: MIT
#include "eval/points/cell_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace raymoval {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

/// Writes the cells of a bounding box with as few bits as its extent needs; the order stays.
struct BoxPacking {
  VoxelIndex minimum;
  int x_bits = 0, y_bits = 0, z_bits = 0;

  [[nodiscard]] std::uint64_t pack(VoxelKey key) const {
    const VoxelIndex cell = voxel_index(key) - minimum;
    return ((static_cast<std::uint64_t>(cell.z()) << y_bits | static_cast<std::uint64_t>(cell.y()))
            << x_bits) |
           static_cast<std::uint64_t>(cell.x());
  }
  [[nodiscard]] VoxelKey unpack(std::uint64_t packed) const {
    const auto take = [&packed](int bits) {
      const auto value = static_cast<int>(packed & ((std::uint64_t{1} << bits) - 1));
      packed >>= bits;
      return value;
    };
    const int x = take(x_bits);
    const int y = take(y_bits);
    const int z = take(z_bits);
    return voxel_key(x + minimum.x(), y + minimum.y(), z + minimum.z());
  }
};

int bits_of(int extent) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(extent)));
}

BoxPacking packing_of(const std::vector<CellPoint>& points) {
  VoxelIndex minimum = voxel_index(points.front().key);
  VoxelIndex maximum = minimum;
  for (const CellPoint& point : points) {
    const VoxelIndex cell = voxel_index(point.key);
    minimum = minimum.cwiseMin(cell);
    maximum = maximum.cwiseMax(cell);
  }
  const VoxelIndex extent = maximum - minimum;
  return {minimum, bits_of(extent.x()), bits_of(extent.y()), bits_of(extent.z())};
}

/// One pass of a least-significant-digit radix sort; keeps the order of equal digits.
void sort_by_digit(const std::vector<CellPoint>& from, std::vector<CellPoint>& to, int shift) {
  const auto digit = [shift](const CellPoint& point) {
    return static_cast<std::size_t>(point.key >> shift) & (kDigits - 1);
  };
  std::array<std::size_t, kDigits> place{};
  for (const CellPoint& point : from) ++place[digit(point)];
  std::size_t next = 0;
  for (std::size_t& count : place) {
    const std::size_t first = next;
    next += count;
    count = first;
  }
  for (const CellPoint& point : from) to[place[digit(point)]++] = point;
}

}  // namespace

void sort_by_cell(std::vector<CellPoint>& points) {
  if (points.size() < kDigits) {  // Too few to be worth the counting tables.
    std::sort(points.begin(), points.end(), [](const CellPoint& a, const CellPoint& b) {
      return a.key != b.key ? a.key < b.key : a.point < b.point;
    });
    return;
  }
  const BoxPacking packing = packing_of(points);
  for (CellPoint& point : points) point.key = packing.pack(point.key);
  std::vector<CellPoint> other(points.size());
  const int bits = packing.x_bits + packing.y_bits + packing.z_bits;
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    sort_by_digit(points, other, shift);
    points.swap(other);
  }
  for (CellPoint& point : points) point.key = packing.unpack(point.key);
}

}  // namespace raymoval
