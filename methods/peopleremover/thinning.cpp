// SPDX-License-Identifier: MIT
#include "methods/peopleremover/thinning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace raymoval::peopleremover_method {
namespace {

/// Scrambles a number (splitmix64, Steele et al. 2014, public domain).
std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Nearly square cells of equal height over the sphere, each about as large as a cap of half-angle
/// `angle`: 2 pi (1 - cos angle) steradians.
class SphereCells {
 public:
  explicit SphereCells(double angle) {
    constexpr double kPi = std::numbers::pi;
    const double side = std::sqrt(2.0 * kPi * (1.0 - std::cos(std::min(angle, kPi))));
    rows_ = std::max(1.0, std::round(kPi / side));
  }
  [[nodiscard]] std::uint64_t cell_of(const Eigen::Vector3d& point) const {
    constexpr double kPi = std::numbers::pi;
    const double elevation = std::asin(std::clamp(point.z() / point.norm(), -1.0, 1.0));
    const double row = std::clamp(std::floor((elevation / kPi + 0.5) * rows_), 0.0, rows_ - 1.0);
    const double middle = ((row + 0.5) / rows_ - 0.5) * kPi;
    const double columns = std::max(1.0, std::round(2.0 * rows_ * std::cos(middle)));
    const double turn = (std::atan2(point.y(), point.x()) / kPi + 1.0) / 2.0;
    const double column = std::clamp(std::floor(turn * columns), 0.0, columns - 1.0);
    return static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint64_t>(column);
  }

 private:
  double rows_;
};

}  // namespace

std::vector<std::uint8_t> choose_beams(const std::vector<Eigen::Vector3d>& points, std::size_t scan,
                                       const Thinning& thinning) {
  if (thinning.points <= 0) return std::vector<std::uint8_t>(points.size(), 1);
  const SphereCells cells(thinning.angle);
  const std::uint64_t of_scan = scrambled(scrambled(thinning.seed) ^ scan);
  struct Ticket {
    std::uint64_t cell, lot, point;
  };
  std::vector<Ticket> tickets;
  tickets.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    tickets.push_back({cells.cell_of(points[k]), scrambled(of_scan ^ k), k});
  }
  std::sort(tickets.begin(), tickets.end(), [](const Ticket& a, const Ticket& b) {
    return std::tie(a.cell, a.lot, a.point) < std::tie(b.cell, b.lot, b.point);
  });
  std::vector<std::uint8_t> chosen(points.size(), 0);
  int taken = 0;
  for (std::size_t i = 0; i < tickets.size(); ++i) {
    taken = i > 0 && tickets[i].cell == tickets[i - 1].cell ? taken + 1 : 0;
    if (taken < thinning.points) chosen[tickets[i].point] = 1;
  }
  return chosen;
}

}  // namespace raymoval::peopleremover_method
