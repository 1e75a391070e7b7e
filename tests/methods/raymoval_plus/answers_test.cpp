// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/answers.h"

#include <catch2/catch.hpp>
#include <span>
#include <vector>

#include "core/scan/mask_store.h"
#include "methods/raymoval_plus/evidence/located_scan.h"
#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;
using namespace raymoval::raymoval_plus_method;

namespace {

constexpr int kScans = 10;
/// The points of a scan of `Street`: the walker, the partly dynamic object, the two points of
/// ground at its foot, and the ground below these.
constexpr std::size_t kWalker = 0, kFoot = 38, kBeside = 39, kPoints = 42;

/// A scan's points; dynamic points come first in each object. The ground is at z = 0.
std::vector<Eigen::Vector3d> points_of(int scan) {
  std::vector<Eigen::Vector3d> points;
  const double x = 10.1 + 0.4 * scan;  // The walker moves by two voxels per scan.
  for (int k = 0; k < 20; ++k) points.emplace_back(x, -15.1, 0.7 + 0.1 * k);
  for (const double z : {0.7, 0.75, 0.9, 1.1}) points.emplace_back(10.1, 0.1, z);
  for (const double z : {0.7, 0.9}) points.emplace_back(10.3, 0.1, z);
  for (int k = 0; k < 12; ++k) points.emplace_back(10.3, 0.45, 0.9 + 0.1 * k);
  points.emplace_back(10.3, 0.1, 0.35);
  points.emplace_back(10.5, 0.1, 0.35);
  points.emplace_back(10.3, 0.1, 0.02);
  points.emplace_back(10.5, 0.1, 0.02);
  return points;
}

/// Whether scans observed a point's voxel as free. There are no observations of the walker's place
/// in the last three scans.
bool is_seen_through(int scan, std::size_t point) {
  return point < 20 ? scan < 7 : point < 26;
}

/// A terrain, a map with the verdicts of the scene, and the scans.
struct Street {
  explicit Street(const Parameters& some)
      : parameters(some), terrain(parameters), maps(parameters) {
    add_ground();
    for (int i = 0; i < kScans; ++i) {
      scans.add_world(Pose::Identity(), points_of(i));
      add_to_map(i);
    }
  }
  void add_ground() {
    LocatedScan plane;
    for (int x = 0; x < 200; ++x) {
      for (int y = -200; y < 50; ++y) {
        plane.scan.points.emplace_back(0.1F * static_cast<float>(x) + 0.05F,
                                       0.1F * static_cast<float>(y) + 0.05F, 0.02F);
      }
    }
    find_terrain_cells(terrain, parameters, RunContext{}, plane);
    terrain.add(plane.in_terrain, RunContext{});
    terrain.update(RunContext{});
  }
  void add_to_map(int scan) {
    LocatedScan located;
    located.scan = scans.load(static_cast<std::size_t>(scan));
    find_terrain_cells(terrain, parameters, RunContext{}, located);
    find_heights_and_cells(terrain, maps, parameters, RunContext{}, located);
    add_to_maps(parameters, RunContext{}, located, maps);
    EvidenceMap& map = maps.standing;
    for (std::size_t k = 0; k < kPoints; ++k) {
      if (!located.has_standing_voxel(k)) continue;
      const std::uint32_t voxel = located.voxel[k];
      map.evidence(voxel).agree_scans = 1;
      EvidenceMap::Blocks::Cursor cursor;
      map.set_verdict_in(map.find_slot(map.index(voxel), cursor),
                         is_seen_through(scan, k) ? Verdict::kDynamic : Verdict::kStatic);
    }
  }
  [[nodiscard]] MaskStore masks(EvidenceSink* evidence) const {
    Masks masks(scans.size());
    RunContext context;
    context.evidence = evidence;
    answer_from_map(terrain, maps, parameters, scans, masks, context);
    return masks.store;
  }

  Parameters parameters;
  Terrain terrain;
  EvidenceMaps maps;
  HeldScans scans;
};

struct NoEvidence : EvidenceSink {
  void accept(std::size_t /*scan*/, std::span<const float> /*evidence*/) override {}
};

}  // namespace

TEST_CASE("who asks for confidence gets the same masks, also where clusters have ground in them") {
  // Points below 0.5 m are ground, and points above 0.2 m are clustered. Of the object, 6 of 20
  // points are dynamic, so that it keeps the verdicts of its voxels. The points of ground at its
  // foot are as high as clustered points, and do not follow the object above them. If they did, the
  // first point would have these 6 and 2 others around it, itself included, and be removed, and
  // then the other point as well, but only if step 8 runs twice.
  Parameters parameters;
  parameters.object_height = 0.2;
  parameters.ground_height = 0.5;
  const Street street(parameters);
  NoEvidence evidence;
  const MaskStore plain = street.masks(nullptr), asked = street.masks(&evidence);
  for (std::size_t i = 0; i < street.scans.size(); ++i) {
    CAPTURE(i);
    const Mask mask = plain.get(i);
    CHECK(mask == asked.get(i));
    CHECK(mask[kWalker] == 1);  // In the last three scans a track marks it.
    CHECK(mask[kFoot] == 0);
    CHECK(mask[kBeside] == 0);
  }
}

}  // namespace raymoval::raymoval_plus_test
