// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace raymoval::patchwork {

/// The concentric zone model: four zones around the sensor, each of rings of equal width that are
/// cut into sectors of equal angle.
class ZoneModel {
 public:
  static constexpr int kNone = -1;
  static constexpr std::array<int, 4> kRings{2, 4, 4, 4};
  static constexpr std::array<int, 4> kSectors{16, 32, 54, 32};
  static constexpr int kAllRings = 14;
  static constexpr int kAllBins = 2 * 16 + 4 * 32 + 4 * 54 + 4 * 32;

  /// @param from, to horizontal distances where the first zone begins and the last one ends, metres
  ZoneModel(double from, double to);

  /// The bin of a place, `kNone` if it lies in no zone. Sector 0 begins at +x and goes toward +y.
  [[nodiscard]] int bin_of(double x, double y) const;
  /// The first bin of a ring; that of ring `kAllRings` is `kAllBins`.
  [[nodiscard]] static int first_bin(int ring);
  /// The ring of a bin, counted from the sensor over all zones.
  [[nodiscard]] static int ring_of(int bin);
  [[nodiscard]] static bool is_innermost_zone(int bin) { return bin < kRings[0] * kSectors[0]; }
  /// Where the zones begin, and the last one ends, metres.
  [[nodiscard]] const std::array<double, 5>& bounds() const { return bounds_; }

 private:
  std::array<double, 5> bounds_;
};

}  // namespace raymoval::patchwork
