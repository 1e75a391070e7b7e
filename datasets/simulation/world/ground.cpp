// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/text.h"
#include "datasets/simulation/shapes/random.h"
#include "datasets/simulation/shapes/shapes.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBucket = 16.0;  // metres
constexpr double kReach = 48.0;   // metres around a bucket within which it lists segments
constexpr double kLandTile = 32.0;

std::uint64_t cell_key(long x, long y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) |
         static_cast<std::uint32_t>(y);
}

long cell_of(double x, double size) {
  return static_cast<long>(std::floor(x / size));
}

double distance_to(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - share * along).norm();
}

/// Height of a road's cross-section above the land's height, `d` metres from its middle.
double profile(const Road& road, double d) {
  const double half = 0.5 * road.width_m;
  if (d <= half) return road.crown_m * (1.0 - (d / half) * (d / half));
  return road.sidewalk_m > 0.0 ? road.kerb_m : 0.0;
}

}  // namespace

Ground::Ground(Terrain terrain, std::vector<Road> roads, std::uint64_t seed)
    : terrain_(terrain), roads_(std::move(roads)), seed_(seed) {
  Random random(seed_, Purpose::kHills);
  for (int i = 0; i < 4 && terrain_.hills_m != 0.0; ++i) {
    const double angle = random.between(0.0, 2.0 * std::numbers::pi);
    const double wave = 2.0 * std::numbers::pi / (terrain_.wavelength_m * random.between(0.7, 1.6));
    waves_.push_back(
        {wave * Vector2d(std::cos(angle), std::sin(angle)), random.between(0.0, 6.28)});
  }
  for (const Road& road : roads_) enter_in_buckets(road);
}

void Ground::enter_in_buckets(const Road& road) {
  const auto& points = road.path.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector2d low = points[i - 1].cwiseMin(points[i]).array() - kReach;
    const Vector2d high = points[i - 1].cwiseMax(points[i]).array() + kReach;
    for (long x = cell_of(low.x(), kBucket); x <= cell_of(high.x(), kBucket); ++x) {
      for (long y = cell_of(low.y(), kBucket); y <= cell_of(high.y(), kBucket); ++y) {
        const Vector2d middle((static_cast<double>(x) + 0.5) * kBucket,
                              (static_cast<double>(y) + 0.5) * kBucket);
        if (distance_to(middle, points[i - 1], points[i]) > kReach + kBucket) continue;
        buckets_[cell_key(x, y)].push_back({&road, points[i - 1], points[i]});
      }
    }
  }
}

const Road& Ground::road(const std::string& name) const {
  std::vector<std::string> names;
  for (const Road& road : roads_) {
    if (road.name == name) return road;
    names.push_back(road.name);
  }
  throw ConfigurationError("there is no road '" + name + "'." + suggestion(name, names));
}

Ground::Near Ground::nearest(const Vector2d& p, const Road* except) const {
  Near best;
  double best_clearance = 1e9;
  const auto bucket = buckets_.find(cell_key(cell_of(p.x(), kBucket), cell_of(p.y(), kBucket)));
  if (bucket == buckets_.end()) return best;
  for (const Segment& segment : bucket->second) {
    if (segment.road == except) continue;
    const double distance = distance_to(p, segment.a, segment.b);
    // The carriageway that extends farthest over the point is used; it takes precedence over a
    // sidewalk.
    const double edge = distance - 0.5 * segment.road->width_m;
    if (edge < best_clearance) {
      best_clearance = edge;
      best = {segment.road, distance};
    }
  }
  return best;
}

double Ground::clearance(const Vector2d& p, const Road* except) const {
  const Near near = nearest(p, except);
  return near.road == nullptr ? kReach : near.distance - near.road->half_corridor();
}

double Ground::hills(const Vector2d& p) const {
  double height = 0.0;
  for (const Wave& wave : waves_) height += std::sin(wave.per_metre.dot(p) + wave.phase);
  const double rise = terrain_.slope.dot(p);
  if (waves_.empty()) return rise;
  return rise + terrain_.hills_m * height / static_cast<double>(waves_.size());
}

double Ground::height(const Vector2d& p) const {
  const Near near = nearest(p, nullptr);
  const double base = hills(p);
  if (near.road == nullptr || near.distance > near.road->half_corridor()) return base;
  return base + profile(*near.road, near.distance);
}

/// Height of the land mesh: rough, and lowered below roads.
double Ground::surface(const Vector2d& p) const {
  const double clear = clearance(p);
  Random random(seed_, Purpose::kHills, mix(static_cast<std::uint64_t>(std::lround(p.x() * 8))),
                static_cast<std::uint64_t>(std::lround(p.y() * 8)));
  const double rough = terrain_.roughness_m * random.normal();
  const double sink = clear < 1.5 * terrain_.grid_m ? -0.35 : 0.0;
  return hills(p) + rough + sink;
}

std::vector<Ground::Piece> Ground::pieces() const {
  std::vector<Piece> pieces;
  for (const Road& road : roads_) add_road(road, pieces);
  add_land(pieces);
  return pieces;
}

namespace {

/// One strip of a road's cross-section: from `left` metres and `rise` to the next.
struct Strip {
  double from, to, rise_from, rise_to;
  Paint paint;
};

std::vector<Strip> strips(const Road& road, bool paved_land, bool soil_land) {
  const double half = 0.5 * road.width_m;
  const Paint lane{road.gravel ? Material::kSoil : Material::kAsphalt, kLabelRoad};
  const Paint kerb{Material::kConcrete, kLabelSidewalk};
  const Paint verge{
      soil_land ? Material::kSoil : (paved_land ? Material::kAsphalt : Material::kGrass),
      static_cast<std::uint32_t>(paved_land ? kLabelOtherGround : kLabelTerrain)};
  std::vector<Strip> result;
  const auto crown = [&](double at) { return road.crown_m * (1.0 - (at / half) * (at / half)); };
  constexpr int kLanes = 6;
  for (int i = 0; i < kLanes; ++i) {
    const double a = -half + road.width_m * i / kLanes;
    const double b = -half + road.width_m * (i + 1) / kLanes;
    result.push_back({a, b, crown(a), crown(b), lane});
  }
  const double outer = road.half_corridor();
  const double top = road.sidewalk_m > 0.0 ? road.kerb_m : 0.0;
  for (const double side : {-1.0, 1.0}) {
    if (top > 0.0) {
      result.push_back({side * half, side * half, 0.0, top, kerb});
      result.push_back({side * half, side * outer, top, top, kerb});
    }
    const double shoulder = outer + 0.4 * road.verge_m;
    result.push_back({side * outer, side * shoulder, top, 0.0, verge});
    result.push_back({side * shoulder, side * (outer + road.verge_m), 0.0, -0.35, verge});
  }
  return result;
}

}  // namespace

void Ground::add_road(const Road& road, std::vector<Piece>& pieces) const {
  constexpr double kStep = 2.0;
  constexpr int kStepsAPiece = 12;
  const std::vector<Strip> section = strips(road, terrain_.paved, terrain_.soil);
  const int steps = static_cast<int>(std::ceil(road.path.length() / kStep));
  const double step = road.path.length() / steps;
  for (int i = 0; i < steps; ++i) {
    const double s = i * step;
    if (i % kStepsAPiece == 0) {
      const Vector2d at = road.path.at(s);
      pieces.push_back({Vector3d(at.x(), at.y(), 0.0), {}});
    }
    Piece& piece = pieces.back();
    for (const Strip& strip : section) {
      const Vector2d middle = road.path.at(s + 0.5 * step, 0.5 * (strip.from + strip.to));
      const Near other = nearest(middle, &road);
      const bool lane = strip.paint.label == kLabelRoad;
      // Kerbs and verges end where another carriageway crosses.
      if (!lane && other.road != nullptr && other.distance < other.road->half_corridor() + 0.3) {
        if (other.distance < 0.5 * other.road->width_m + 0.3 || strip.rise_to <= 0.0) continue;
      }
      const auto corner = [&](double along, double left, double rise) {
        const Vector2d p = road.path.at(along, left);
        return Vector3d(Vector3d(p.x(), p.y(), hills(p) + rise) - piece.origin);
      };
      add_quad(piece.mesh, strip.paint, corner(s, strip.from, strip.rise_from),
               corner(s + step, strip.from, strip.rise_from),
               corner(s + step, strip.to, strip.rise_to), corner(s, strip.to, strip.rise_to));
    }
  }
}

/// Cells of `kLandTile` metres that lie within the margin of a road, sorted.
std::vector<std::uint64_t> Ground::land_cells() const {
  std::vector<std::uint64_t> keys;
  const long reach = cell_of(terrain_.margin_m, kLandTile) + 1;
  for (const Road& road : roads_) {
    for (double s = 0.0; s <= road.path.length(); s += 0.5 * kLandTile) {
      const Vector2d p = road.path.at(s);
      const long cx = cell_of(p.x(), kLandTile);
      const long cy = cell_of(p.y(), kLandTile);
      for (long x = cx - reach; x <= cx + reach; ++x) {
        for (long y = cy - reach; y <= cy + reach; ++y) keys.push_back(cell_key(x, y));
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

void Ground::add_land(std::vector<Piece>& pieces) const {
  const Paint paint{
      terrain_.soil ? Material::kSoil : (terrain_.paved ? Material::kAsphalt : Material::kGrass),
      static_cast<std::uint32_t>(terrain_.paved ? kLabelOtherGround : kLabelTerrain)};
  const int cells = std::max(1, static_cast<int>(std::lround(kLandTile / terrain_.grid_m)));
  const double grid = kLandTile / cells;
  for (const std::uint64_t key : land_cells()) {
    const double x0 = static_cast<std::int32_t>(key >> 32) * kLandTile;
    const double y0 = static_cast<std::int32_t>(key & 0xFFFFFFFFU) * kLandTile;
    Piece piece{Vector3d(x0, y0, 0.0), {}};
    for (int y = 0; y <= cells; ++y) {
      for (int x = 0; x <= cells; ++x) {
        const Vector2d p(x0 + x * grid, y0 + y * grid);
        piece.mesh.vertex({x * grid, y * grid, surface(p)});
      }
    }
    const auto row = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t y = 0; y + 1 < row; ++y) {
      for (std::uint32_t x = 0; x + 1 < row; ++x) {
        const std::uint32_t a = y * row + x;
        piece.mesh.triangle(a, a + 1, a + row + 1, paint);
        piece.mesh.triangle(a, a + row + 1, a + row, paint);
      }
    }
    pieces.push_back(std::move(piece));
  }
}

}  // namespace raymoval::simulated
