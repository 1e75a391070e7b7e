// SPDX-License-Identifier: MIT
// The whole method against one by the letter of its description, with a set of scan numbers in each
// voxel, and what must not change an answer.
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "methods/common/sparse_blocks.h"
#include "methods/peopleremover/beams.h"
#include "tests/methods/moved_world.h"
#include "tests/methods/peopleremover/listed_scans.h"
#include "tests/methods/peopleremover/slow_path.h"

namespace raymoval::peopleremover_test {
using namespace raymoval::peopleremover_method;

namespace {

using Scans = std::set<int>;

/// Steps 2.1 to 2.10, slowly. Beam ends are those of the fast code, which has an oracle of its own.
class SlowPeopleremover {
 public:
  SlowPeopleremover(const Parameters& parameters, const ScanSource& scans)
      : p_(parameters), scans_(scans) {
    for (std::size_t i = 0; i < scans.size(); ++i) insert(static_cast<int>(i));
    for (std::size_t i = 0; i < scans.size(); ++i) trace(static_cast<int>(i));
    discard_clusters();
    spread();
  }

  [[nodiscard]] Mask mask(std::size_t i) const {
    const Scan scan = scans_.load(i);
    Mask mask;
    for (const auto& point : scan.points) {
      const Eigen::Vector3d local = point.cast<double>();
      const VoxelKey x = key_of(scan.T_world_sensor * local);
      const auto half = half_.find(x);
      const bool dynamic = takes_part(local) &&
                           (freed_.contains(x) ||
                            (half != half_.end() && half->second.contains(static_cast<int>(i))));
      mask.push_back(dynamic ? 1 : 0);
    }
    return mask;
  }

 private:
  [[nodiscard]] VoxelKey key_of(const Eigen::Vector3d& world) const {
    return voxel_key(voxel_index(world, 1.0 / p_.voxel_size));
  }
  [[nodiscard]] bool takes_part(const Eigen::Vector3d& local) const {
    return local.squaredNorm() > 3.0 * p_.voxel_size * p_.voxel_size;
  }
  void insert(int i) {
    const Scan scan = scans_.load(static_cast<std::size_t>(i));
    for (const auto& point : scan.points) {
      const Eigen::Vector3d local = point.cast<double>();
      if (takes_part(local)) occupied_[key_of(scan.T_world_sensor * local)].insert(i);
    }
  }
  void trace(int i) {
    const Scan scan = scans_.load(static_cast<std::size_t>(i));
    std::vector<Eigen::Vector3d> points;
    for (const auto& point : scan.points) {
      if (takes_part(point.cast<double>())) points.push_back(point.cast<double>());
    }
    const std::vector<double> lengths = BeamEnds(p_).find(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector3d end =
          lengths[k] == kWholeBeam ? points[k]
                                   : Eigen::Vector3d(points[k] * (lengths[k] / points[k].norm()));
      follow(i, scan.T_world_sensor.translation() * (1.0 / p_.voxel_size),
             (scan.T_world_sensor * end) * (1.0 / p_.voxel_size));
    }
  }
  /// @return whether the beam continues
  bool visit(int i, VoxelKey x) {
    const auto found = occupied_.find(x);
    if (found == occupied_.end()) return true;
    const auto first = found->second.lower_bound(std::max(0, i - p_.diff));
    if (first != found->second.end() && *first <= i + p_.diff) return false;
    freed_.insert(x);
    return true;
  }
  void follow(int i, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    if (from == to) return;
    const std::vector<VoxelKey> path = slow_path(from, to);
    for (std::size_t k = 0; k < path.size(); ++k) {
      if (!visit(i, path[k]) && k > 0) return;
    }
  }
  void discard_clusters() {
    std::set<VoxelKey> left = freed_;
    while (!left.empty()) {
      std::vector<VoxelKey> cluster{*left.begin()};
      left.erase(left.begin());
      for (std::size_t k = 0; k < cluster.size(); ++k) {
        for_each_around(voxel_index(cluster[k]), 1, [&](const VoxelIndex& x) {
          if (left.erase(voxel_key(x)) > 0) cluster.push_back(voxel_key(x));
        });
      }
      if (static_cast<int>(cluster.size()) >= p_.min_cluster_size) continue;
      for (const VoxelKey x : cluster) freed_.erase(x);
    }
  }
  void spread() {
    if (!p_.subvoxel_accuracy) return;
    for (const VoxelKey y : freed_) {
      for_each_around(voxel_index(y), p_.half_voxel_radius, [&](const VoxelIndex& at) {
        const VoxelKey x = voxel_key(at);
        if (!occupied_.contains(x) || freed_.contains(x)) return;
        half_[x].insert(occupied_[y].begin(), occupied_[y].end());
      });
    }
  }

  Parameters p_;
  const ScanSource& scans_;
  std::map<VoxelKey, Scans> occupied_, half_;
  std::set<VoxelKey> freed_;
};

/// Every `step`-th point of the scans of another source.
ListedScans thinned(const ScanSource& source, std::size_t step) {
  ListedScans scans;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Scan scan = source.load(i);
    std::vector<Eigen::Vector3d> world;
    for (std::size_t k = i % step; k < scan.size(); k += step) {
      world.emplace_back(scan.T_world_sensor * scan.points[k].cast<double>());
    }
    scans.scan(scan.T_world_sensor, world);
  }
  return scans;
}

}  // namespace

TEST_CASE("peopleremover answers as one with a set of scans in each voxel", "[peopleremover]") {
  const ListedScans scans = thinned(street(9), 7);
  constexpr auto kNormals = MaxrangeMethod::kNormals, kNone = MaxrangeMethod::kNone;
  const std::vector<Parameters> settings{
      {.maxrange_method = kNormals},
      {.maxrange_method = kNone},
      {.maxrange_method = kNone, .diff = 1},
      {.maxrange_method = kNormals, .diff = 3},
      {.maxrange_method = kNormals, .subvoxel_accuracy = false},
      {.maxrange_method = kNone, .min_cluster_size = 60},
      {.voxel_size = 0.1, .maxrange_method = kNormals, .min_cluster_size = 0},
      {.voxel_size = 0.4, .maxrange_method = kNormals, .half_voxel_radius = 5},
  };
  for (std::size_t s = 0; s < settings.size(); ++s) {
    const MaskStore masks = masks_of(*make_peopleremover(settings[s]), scans);
    const SlowPeopleremover slow(settings[s], scans);
    INFO("setting " << s);
    CHECK(masks.removed_count() > 20);
    for (std::size_t i = 0; i < scans.size(); ++i) REQUIRE(masks.get(i) == slow.mask(i));
  }
}

TEST_CASE("peopleremover removes what moves on the street and keeps the rest", "[peopleremover]") {
  const World world = street(12);
  const MaskStore masks = masks_of(*peopleremover("normals", {}).make(), world);
  CHECK(removed_share(world, masks, 0, 0, 11) < 0.05);  // Road.
  CHECK(removed_share(world, masks, 1, 0, 11) < 0.01);  // Wall.
  // Beams never pass an object before the sky or out of reach of the rows.
  CHECK(removed_share(world, masks, 3, 0, 6) > 0.5);  // Car.
  CHECK(removed_share(world, masks, 4, 0, 8) > 0.7);  // Person.
  // Whole beams take a good part of the road with them.
  const MaskStore whole = masks_of(*peopleremover("none", {}).make(), world);
  CHECK(removed_share(world, whole, 0, 0, 11) > 0.2);
}

}  // namespace raymoval::peopleremover_test
