// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/shapes/random.h"
#include "datasets/simulation/world/ego.h"
#include "datasets/simulation/world/ground.h"
#include "datasets/simulation/world/mover.h"

namespace raymoval::simulated {

struct FlowSpec;
struct MoverSpec;
struct PlaceSpec;
struct QueueSpec;
struct RowSpec;
struct WorldFile;

/// A square of the static world. Its mesh is relative to `origin`, so that single precision is
/// finer than 0.01 mm even kilometres from the origin of the world.
struct Tile {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Mesh mesh;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(),
                  high = Eigen::Vector3d::Zero();  ///< Bounds in the world.
};

/// All surfaces of the world and their motion.
class World {
 public:
  World() = default;
  /// Builds the world of `file`. Static parts depend on the file only, movers also on `seed`;
  /// `duration` (seconds) decides which objects count as moving.
  /// @throws ConfigurationError naming what does not fit.
  World(const WorldFile& file, std::uint64_t seed, double duration);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Adds a static mesh to the tile of its origin.
  void add_static(const Mesh& mesh, const Eigen::Isometry3d& T_world_mesh);
  void add_mover(Mover mover) { movers_.push_back(std::make_unique<Mover>(std::move(mover))); }
  void set_air(const Air& air) { air_ = air; }
  /// Fixes the tiles' bounds; call it once, after the last `add_static`.
  void finish();

  [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Mover>>& movers() const { return movers_; }
  [[nodiscard]] const Air& air() const { return air_; }
  [[nodiscard]] const std::optional<Ego>& ego() const { return ego_; }
  [[nodiscard]] const Ground* ground() const { return ground_.get(); }
  /// Parts that are not static, for each of `times` in the same order: parts of movers that are
  /// present at `reference` within `reach` metres of `around`, and of the ego vehicle.
  [[nodiscard]] std::vector<std::vector<PlacedPart>> parts(const std::vector<double>& times,
                                                           double reference,
                                                           const Eigen::Vector3d& around,
                                                           double reach) const;

 private:
  void add_row(const RowSpec& row, std::uint64_t seed, std::uint64_t number);
  void add_place(const PlaceSpec& place, std::uint64_t seed, std::uint64_t number);
  void add_movers(const MoverSpec& spec, std::uint64_t seed, std::uint64_t number);
  void add_flow(const FlowSpec& flow, std::uint64_t seed, std::uint64_t number, double duration);
  void add_queue(const QueueSpec& queue, std::uint64_t seed, std::uint64_t number);
  void add_parked(const std::string& kind, const Presence& presence, const Eigen::Vector2d& at,
                  const Eigen::Vector2d& along, Random& random);
  std::uint16_t next_instance();

  std::unique_ptr<Ground> ground_;
  std::vector<Tile> tiles_;
  std::vector<std::unique_ptr<Mover>> movers_;
  std::optional<Ego> ego_;
  Air air_;
  std::uint16_t instances_ = 0;
};

}  // namespace raymoval::simulated
