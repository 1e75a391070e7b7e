// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <initializer_list>

namespace raymoval::simulated {

/// The purpose of a random number. Streams of different purposes never share numbers.
enum class Purpose : std::uint64_t {
  kHills = 1,
  kPart,
  kFlow,
  kMover,
  kSensor,
  kRange,
  kDrop,
  kDivergence,
  kDrift,
  kJitter,
  kPhase,
  kQueue,
  kPause,
  kGlass,
  kEcho,
};

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection that mixes all bits.
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// One word from several; the order matters.
constexpr std::uint64_t mix_all(std::initializer_list<std::uint64_t> words) {
  std::uint64_t state = 0;
  for (const std::uint64_t word : words) state = mix(state ^ word);
  return state;
}

/// Uniform in [0, 1) from a random word.
constexpr double to_unit(std::uint64_t word) {
  return static_cast<double>(word >> 11) * 0x1.0p-53;
}

/// Close to a standard normal: the sum of four uniforms, scaled (bounded by 3.46; no logarithm or
/// cosine, so the same bytes on any machine).
constexpr double to_normal(std::uint64_t word) {
  const double sum = static_cast<double>((word & 0xFFFF) + ((word >> 16) & 0xFFFF) +
                                         ((word >> 32) & 0xFFFF) + (word >> 48)) /
                     65535.0;
  return (sum - 2.0) * 1.7320508075688772;
}

/// Numbers that depend only on the key: number k is a hash of (key, k).
class Random {
 public:
  Random(std::uint64_t seed, Purpose purpose, std::uint64_t a = 0, std::uint64_t b = 0)
      : key_(mix_all({seed, static_cast<std::uint64_t>(purpose), a, b})) {}
  std::uint64_t word() { return mix(key_ ^ (counter_++ * 0xD1342543DE82EF95ULL)); }
  double unit() { return to_unit(word()); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  double normal() { return to_normal(word()); }
  bool chance(double probability) { return unit() < probability; }
  int below(int count) { return static_cast<int>(unit() * count); }

  // Compilers evaluate the arguments of a call in different orders, so these functions draw each
  // coordinate in a separate statement: z, then y, then x.

  Eigen::Vector3d normals() {
    const double z = normal(), y = normal(), x = normal();
    return {x, y, z};
  }
  /// Each coordinate between that of `low` and that of `high`.
  Eigen::Vector3d within(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const double z = between(low.z(), high.z());
    const double y = between(low.y(), high.y());
    const double x = between(low.x(), high.x());
    return {x, y, z};
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 1;
};

}  // namespace raymoval::simulated
