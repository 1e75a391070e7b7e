// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/world/path.h"

namespace raymoval::simulated {

/// The medium of the light: glass, fog, rain.
struct Air {
  /// Share of shots that pass a pane and continue to the surface behind it.
  double glass_through = 0.0;
  /// Distance in metres at which 5 % of light is left (the meteorological optical range;
  /// Koschmieder 1924). Rain, fog or dust absorb light on the way there and back.
  double visibility_m = std::numeric_limits<double>::infinity();
  /// Share of shots that hit a drop or a flake with enough light for a return, if no surface is
  /// before it. Such points are outliers (label 1).
  double echo_share = 0.0;
  /// Mean distance of these drops in metres. Their density falls exponentially, because only near
  /// drops are bright enough.
  double echo_range_m = 6.0;
};

/// A carriageway with its kerbs, sidewalks and verges.
struct Road {
  std::string name;
  Path path;
  double width_m = 7.0;
  double crown_m = 0.08;    ///< Height of the middle above the edges.
  double kerb_m = 0.12;     ///< Height of the sidewalk above the edge of the carriageway.
  double sidewalk_m = 2.0;  ///< Width on each side; 0 = none.
  double verge_m = 4.0;     ///< Strip from the road down to the terrain.
  bool gravel = false;      ///< Gravel instead of asphalt.

  [[nodiscard]] double half_corridor() const { return 0.5 * width_m + sidewalk_m; }
};

/// Land between and around the roads.
struct Terrain {
  double hills_m = 0.0;  ///< Height of the hills above the mean.
  double wavelength_m = 120.0;
  double margin_m = 70.0;  ///< Extent of the land beside roads.
  double roughness_m = 0.04;
  double grid_m = 2.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< Rise of all the land, metres per metre.
  bool paved = false;                               ///< Paved or soil instead of grass.
  bool soil = false;
};

/// Height of the land anywhere, and the triangles of it.
class Ground {
 public:
  Ground(Terrain terrain, std::vector<Road> roads, std::uint64_t seed);
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;

  /// Height of road, sidewalk or land at `p`, without roughness.
  [[nodiscard]] double height(const Eigen::Vector2d& p) const;
  /// Distance to the middle of the nearest road other than `except` within 48 m, minus the half
  /// width of its carriageway and sidewalk: negative on the road.
  [[nodiscard]] double clearance(const Eigen::Vector2d& p, const Road* except = nullptr) const;
  [[nodiscard]] const std::vector<Road>& roads() const { return roads_; }
  /// @throws ConfigurationError suggesting the nearest name.
  [[nodiscard]] const Road& road(const std::string& name) const;

  /// Pieces of the ground: meshes relative to their own origins.
  struct Piece {
    Eigen::Vector3d origin;
    Mesh mesh;
  };
  [[nodiscard]] std::vector<Piece> pieces() const;

 private:
  struct Near {
    const Road* road = nullptr;
    double distance = 1e9;  ///< To the middle.
  };
  [[nodiscard]] double hills(const Eigen::Vector2d& p) const;
  [[nodiscard]] Near nearest(const Eigen::Vector2d& p, const Road* except) const;
  [[nodiscard]] double surface(const Eigen::Vector2d& p) const;
  void enter_in_buckets(const Road& road);
  void add_road(const Road& road, std::vector<Piece>& pieces) const;
  void add_land(std::vector<Piece>& pieces) const;
  [[nodiscard]] std::vector<std::uint64_t> land_cells() const;

  struct Segment {
    const Road* road;
    Eigen::Vector2d a, b;
  };
  struct Wave {
    Eigen::Vector2d per_metre;
    double phase;
  };
  Terrain terrain_;
  std::vector<Road> roads_;
  std::vector<Wave> waves_;
  std::uint64_t seed_;
  std::unordered_map<std::uint64_t, std::vector<Segment>> buckets_;
};

}  // namespace raymoval::simulated
