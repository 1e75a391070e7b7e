// SPDX-License-Identifier: MIT
#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <set>

#include "core/simd/instruction_set_scope.h"
#include "methods/hmm_mos/distances.h"
#include "methods/hmm_mos/moving_voxels.h"
#include "tests/methods/grid_cells.h"
#include "tests/methods/hmm_mos/oracle.h"
#include "tests/methods/hmm_mos/scenes.h"

namespace raymoval::hmm_mos_test {

namespace {

/// The number of scans that pass a voxel until it is free, after hits in five scans. The scans hit
/// a surface at a squared distance from the voxel.
int scans_until_free(const BeliefModel& model, int distance) {
  double occupied = BeliefModel::kUnobserved;
  for (int i = 0; i < 5; ++i) occupied = model.after(occupied, 0);
  CHECK(model.is_occupied(occupied));
  for (int scans = 1; scans <= 100; ++scans) {
    occupied = model.after(occupied, distance);
    if (model.is_free(occupied)) return scans;
  }
  return -1;
}

void occupy(ScanGrid& grid, const VoxelIndex& voxel) {
  grid.column(voxel).hit |= bit_of(voxel);
}

/// A random voxel around the corner where eight blocks meet.
VoxelIndex random_voxel(std::mt19937& random, int reach) {
  const auto index = [&] { return static_cast<int>(random() % static_cast<unsigned>(2 * reach)); };
  const int x = index() - reach, y = index() - reach;
  return {x, y, index() - reach};
}

}  // namespace

// One hit makes a voxel occupied for sure: p_o is 1. Two voxels off, p_o = exp(-2) = .1353, so that
// the odds of free against occupied grow by (1 - p_o) / p_o = 6.389 a scan, after the step that
// mixes them: .0321, .237, 1.55, 9.83, 59.9, 295; the state turns above .99 / .01 = 99. From a
// squared distance of 20 on they grow by 22,025, and .005 / .995 is enough at once.
TEST_CASE("how long a voxel takes to become free", "[hmm_mos]") {
  const BeliefModel model{Parameters{}};
  CHECK(scans_until_free(model, 4) == 6);
  CHECK(scans_until_free(model, 19) == 2);
  CHECK(scans_until_free(model, 20) == 1);
  CHECK(scans_until_free(model, 1) == -1);  // p_o = .61: next to a hit it stays.
  CHECK(scans_until_free(model, model.far()) == 1);
}

TEST_CASE("a voxel seen for the first time is what its distance says", "[hmm_mos]") {
  const BeliefModel model{Parameters{}};
  CHECK(model.after(BeliefModel::kUnobserved, 0) == 1.0);
  for (const int distance : {1, 2, 5, 9}) {
    CHECK(model.after(BeliefModel::kUnobserved, distance) ==
          Approx(std::exp(-distance / 2.0)).epsilon(1e-12));
  }
  CHECK(model.is_free(model.after(BeliefModel::kUnobserved, 10)));       // exp(-5) = .0067
  CHECK_FALSE(model.is_free(model.after(BeliefModel::kUnobserved, 9)));  // .0111
}

// The bound from which on distances are alike is one that double precision gives: with any longer
// distance the next step comes out the same, to the last bit.
TEST_CASE("distances beyond the bound make no difference", "[hmm_mos]") {
  for (const double spread : {0.25, 1.0, 1.5}) {
    for (const double transition : {0.001, 0.005, 0.1}) {
      Parameters parameters;
      parameters.spread = spread;
      parameters.transition = transition;
      const BeliefModel model(parameters);
      CAPTURE(spread, transition, model.far());
      CHECK(model.far() <= BeliefModel::kMostDistances);
      for (const double before : {0.0, 1e-9, 0.3, 0.5, 0.99, 1.0}) {
        for (const int far : {model.far(), model.far() + 1, 4 * model.far()}) {
          Oracle oracle(parameters);
          Believed& voxel = oracle.map[{0, 0, 0}];
          voxel.belief = {0.0, before, 1.0 - before};
          const double voxels = parameters.voxel_size * parameters.voxel_size;
          oracle.observe({0, 0, 0}, far * voxels);
          CHECK(voxel.state == State::kFree);
          oracle.observe({0, 0, 0}, voxels);
          const double expected = model.after(model.after(before, model.far()), 1);
          CHECK(voxel.belief[1] == Approx(expected).epsilon(1e-13));
        }
      }
    }
  }
}

TEST_CASE("a bound too far for the distances is refused", "[hmm_mos]") {
  Parameters parameters;
  parameters.spread = 3.0;
  CHECK_THROWS_AS(BeliefModel(parameters), ConfigurationError);
}

TEST_CASE("distances to the nearest occupied voxel of two scans, over the borders of blocks",
          "[hmm_mos][simd]") {
  std::mt19937 random(5);
  for (const int far : {1, 2, 20, 96, 254}) {
    for (const InstructionSet set : supported_instruction_sets()) {
      const InstructionSetScope scope(set);
      ScanGrid now, before, beyond;
      std::vector<VoxelIndex> occupied, observed;
      for (int i = 0; i < 40; ++i) {
        occupied.push_back(random_voxel(random, 24));
        occupy(i % 3 == 0 ? before : i % 3 == 1 ? now : beyond, occupied.back());
        observed.push_back(random_voxel(random, 30));
        now.column(observed.back()).free |= bit_of(observed.back());
      }
      DistanceField field(far);
      std::size_t differences = 0;
      for (std::size_t i = 0; i < now.size(); ++i) {
        field.find(now, before, beyond, now[i]);
        for (const VoxelIndex& voxel : observed) {
          if (block_of(voxel) != now[i].at) continue;
          int nearest = far;
          for (const VoxelIndex& other : occupied) {
            nearest = std::min(nearest, (other - voxel).squaredNorm());
          }
          const int height = voxel.z() & (kHeight - 1);
          differences += field.at(column_of(voxel), height) != nearest ? 1 : 0;
        }
      }
      CAPTURE(far, instruction_set_name(set));
      CHECK(differences == 0);
    }
  }
}

// From (0, 0, 0) to (4, 2, 1): the errors begin at 4 / 2 = 2, so that y steps with x = 2 and 4
// would be its half ways: 2 - 2 = 0, -2 (steps), 0, -2 (steps), and z: 1, 0, -1 (steps), 2.
TEST_CASE("rays are lines of whole numbers", "[hmm_mos]") {
  CHECK(Oracle::line({0, 0, 0}, {4, 2, 1}) ==
        std::vector<Cell>{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 1, 1}, {4, 2, 1}});
  CHECK(Oracle::line({1, 1, 1}, {1, 1, 1}) == std::vector<Cell>{{1, 1, 1}});
}

TEST_CASE("what is observed is within range, whatever lies farther off", "[hmm_mos]") {
  Parameters parameters;
  parameters.public_lattice = false;
  parameters.max_range = 10.0;
  toy::HeldScans scans;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points{{5000.0, 3000.0, -2000.0}};
  for (int i = 0; i < 200; ++i) {
    points.push_back(Eigen::Vector3d(any(random), any(random), any(random)) * 14.0);
  }
  scans.add_world({0.3, -0.2, 0.1}, points);
  Oracle oracle(parameters);
  oracle.add(scans.load(0));
  ScanVoxels voxels;
  find_voxels(scans.load(0), parameters, {}, voxels);
  CHECK(toy::cells_of(voxels.grid, &Column::free) == oracle.observed);
  const std::size_t occupied = toy::cells_of(voxels.grid, &Column::hit).size();
  CHECK(occupied == oracle.occupied.size());
  CHECK(occupied + voxels.beyond.size() == points.size());  // Each is alone in its voxel.
  CHECK(voxels.beyond.size() > 10);
}

// Hits of both scans beyond their ranges, near two voxels that this scan observes, over the border
// of a block too. One is far from all blocks.
TEST_CASE("what is hit beyond the range is near to what is within", "[hmm_mos]") {
  ScanVoxels now, before;
  now.grid.column(VoxelIndex(31, 0, 0)).free |= bit_of({31, 0, 0});
  now.grid.column(VoxelIndex(10, 0, 0)).free |= bit_of({10, 0, 0});
  now.beyond = {{33, 0, 0}, {900, 0, 0}};
  before.beyond = {{10, 2, 1}, {31, 0, 2}};
  ScanGrid beyond;
  find_beyond(now, before, beyond);
  CHECK(beyond.find(block_of({900, 0, 0})) == nullptr);
  DistanceField field(20);
  field.find(now.grid, before.grid, beyond, now.grid[0]);
  CHECK(field.at(column_of({31, 0, 0}), 0) == 4);
  CHECK(field.at(column_of({10, 0, 0}), 0) == 5);
  before.beyond.clear();
  find_beyond(now, before, beyond);
  field.find(now.grid, before.grid, beyond, now.grid[0]);
  CHECK(field.at(column_of({31, 0, 0}), 0) == 4);
  CHECK(field.at(column_of({10, 0, 0}), 0) == 20);
}

TEST_CASE("the public lattice is twice as wide around its origin", "[hmm_mos]") {
  Parameters parameters;
  const Lattice cut(parameters);
  parameters.public_lattice = false;
  const Lattice floor(parameters);
  CHECK(cut.voxel_of({-0.2, 0.2, -0.3}) == VoxelIndex(0, 0, -1));
  CHECK(floor.voxel_of({-0.2, 0.2, -0.3}) == VoxelIndex(-1, 0, -2));
  CHECK(cut.sensor_voxel({-0.2, 0.2, -0.3}) == VoxelIndex(-1, 0, -2));
  CHECK(cut.position({-1, 0, 2}) == Eigen::Vector3d(-0.25, 0.0, 0.5));
  CHECK(floor.position({-1, 0, 2}) == Eigen::Vector3d(-0.125, 0.125, 0.625));
}

// Boxes of 14 voxels, of which a share that grows along x is never observed, in many random worlds:
// scores of all signs in tables of many sizes.
TEST_CASE("changes less what is unknown, for each occupied voxel once", "[hmm_mos]") {
  constexpr int kSize = 14;
  std::mt19937 random(17);
  std::size_t positive = 0, others = 0, wrong = 0;
  for (int world = 0; world < 60; ++world) {
    const int reach = 1 + world % 2;
    ScanVoxels past, now;
    ScanGrid &first = past.grid, &second = now.grid;
    occupy(first, {200, 200, 200});  // All is far from it, and free.
    std::set<std::array<int, 3>> known, appeared;
    for (int i = 0; i < kSize * kSize * kSize; ++i) {
      const VoxelIndex voxel(i / kSize / kSize - 5, i / kSize % kSize - 5, i % kSize - 5);
      const bool is_observed = static_cast<int>(random() % 20) > i / kSize / kSize;
      const bool is_hit = random() % 3 == 0;
      if (is_observed) {
        first.column(voxel).free |= bit_of(voxel);
        known.insert({voxel.x(), voxel.y(), voxel.z()});
      }
      if (!is_hit) continue;
      occupy(second, voxel);
      if (is_observed) appeared.insert({voxel.x(), voxel.y(), voxel.z()});
    }
    BeliefMap map{Parameters{}};
    map.observe(past, {}, {});
    map.observe(now, past, {});
    REQUIRE(map.appeared().size() == appeared.size());
    const Scores scores = change_scores(second, map, reach);
    for (int i = 0; i < kSize * kSize * kSize; ++i) {
      const VoxelIndex voxel(i / kSize / kSize - 5, i / kSize % kSize - 5, i % kSize - 5);
      if ((second.column(voxel).hit & bit_of(voxel)) == 0) continue;
      int expected = 0;
      for_each_around(voxel, reach, [&](const VoxelIndex& at) {
        const std::array<int, 3> other{at.x(), at.y(), at.z()};
        expected += appeared.contains(other) ? 1 : known.contains(other) ? 0 : -1;
      });
      const auto found = scores.find(voxel_key(voxel));
      wrong += (found == scores.end() ? 0 : found->second) != std::max(expected, 0) ? 1 : 0;
      ++(expected > 0 ? positive : others);
    }
    CHECK(wrong == 0);
  }
  CHECK(positive > 1000);
  CHECK(others > 1000);
}

// Five voxels in a row along x with these scores. The first has the median of (8, 1), 4.5, cut off.
TEST_CASE("medians of neighbours", "[hmm_mos]") {
  ScanGrid grid;
  Scores scores;
  const std::vector<int> row{8, 1, 5, 0, 7};
  for (int x = 0; x < 5; ++x) {
    occupy(grid, {x, 0, 0});
    if (row[static_cast<std::size_t>(x)] > 0) {
      scores[voxel_key(x, 0, 0)] = row[static_cast<std::size_t>(x)];
    }
  }
  const Scores medians = median_scores(grid, scores);
  const std::vector<int> expected{4, 5, 1, 5, 3};
  for (int x = 0; x < 5; ++x) {
    CHECK(medians.at(voxel_key(x, 0, 0)) == expected[static_cast<std::size_t>(x)]);
  }
  CHECK(medians.size() == 5);
}

TEST_CASE("a window adds up the scores of its scans", "[hmm_mos]") {
  ScoreWindow window(2);
  const VoxelKey a = voxel_key(1, 2, 3), b = voxel_key(4, 5, 6);
  window.add({{a, 3}});
  window.add({{a, 4}, {b, 1}});
  CHECK(window.sum(a) == 7);
  window.add({});
  CHECK(window.sum(a) == 4);
  CHECK(window.sum(b) == 1);
  window.add({});
  CHECK(window.sum(a) == 0);
  CHECK(window.sums().empty());
}

// Scores from 0 to 10 in ten bins: bin 0 has 0 and 1, bin 7 has 8, bin 9 has 10. All edges from 1
// to 7 part the low ones from the high ones alike, and the highest counts.
TEST_CASE("Otsu's threshold is the highest of the best", "[hmm_mos]") {
  CHECK(otsu_threshold({{0, 90}, {1, 5}, {8, 3}, {10, 2}}, 10) == 7.0);
  CHECK(otsu_threshold({{10, 2}, {0, 90}, {8, 3}, {1, 5}}, 10) == 7.0);
  // A hundred bins between 2 and 4: the last edge below 4 is 3.98.
  CHECK(*otsu_threshold({{2, 7}, {4, 1}}, 100) == Approx(3.98));
}

TEST_CASE("equal scores have no threshold", "[hmm_mos]") {
  CHECK_FALSE(otsu_threshold({}, 100).has_value());
  CHECK_FALSE(otsu_threshold({{0, 500}}, 100).has_value());
  CHECK_FALSE(otsu_threshold({{6, 500}}, 100).has_value());
}

}  // namespace raymoval::hmm_mos_test
