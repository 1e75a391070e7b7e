// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/point_runs.h"

#include <limits>

#include "methods/raymoval_plus/objects/fragments.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// What more scans than this agree with, on average over its points, is not remembered. It changes
/// no answer, only how it is found.
constexpr float kMostAgreeing = 20.0F;
/// Objects of a scan that can be numbered in a `PointRun`.
constexpr std::size_t kMostObjects = std::numeric_limits<std::uint16_t>::max();

}  // namespace

bool is_remembered(const std::vector<ObjectSummary>& objects, std::size_t number,
                   const Parameters& parameters) {
  if (number >= kMostObjects) return false;
  const ObjectSummary& object = objects[number];
  return !is_dynamic(object, parameters) && object.hits <= kMostAgreeing;
}

std::vector<PointRun> remembered_points(const SegmentedScan& scan,
                                        const std::vector<ObjectSummary>& objects,
                                        const Parameters& parameters) {
  constexpr int kNotRemembered = -1;
  std::vector<int> object_of(scan.clusters.size(), kNotRemembered);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (!is_remembered(objects, k, parameters)) continue;
    object_of[static_cast<std::size_t>(objects[k].cluster)] = static_cast<int>(k);
  }
  std::vector<PointRun> runs;
  // Points of a part are also of what it was divided from, so that runs of two objects take turns.
  constexpr std::size_t kNoRun = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last_run(objects.size(), kNoRun);
  const auto remember = [&](std::uint32_t point, int object) {
    if (object == kNotRemembered) return;
    std::size_t& last = last_run[static_cast<std::size_t>(object)];
    const bool goes_on = last != kNoRun && runs[last].first + runs[last].count == point &&
                         runs[last].count < std::numeric_limits<std::uint16_t>::max();
    if (goes_on) {
      ++runs[last].count;
    } else {
      last = runs.size();
      runs.push_back({point, 1, static_cast<std::uint16_t>(object)});
    }
  };
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    remember(scan.high_points[i], object_of[static_cast<std::size_t>(scan.cluster_of[i])]);
  }
  const Fragments fragments(scan, parameters);
  for (const ObjectSummary& object : objects) {
    const int number = object_of[static_cast<std::size_t>(object.cluster)];
    if (number == kNotRemembered || is_fragment(object.points, parameters)) continue;
    fragments.for_near(object, [&](std::uint32_t point) { remember(point, number); });
  }
  runs.shrink_to_fit();
  return runs;
}

}  // namespace raymoval::raymoval_plus_method
