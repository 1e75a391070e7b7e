// SPDX-License-Identifier: MIT
#include "benchmark/kernels/workloads.h"

#include <cstdio>
#include <cstdlib>

#include "core/angle.h"
#include "core/error.h"
#include "datasets/open_sequence.h"

namespace raymoval::kernels_bench {
namespace {

constexpr double kNearest = 2.7, kFarthest = 50.0;  // Points of the map, metres from the sensor.

/// The points of a sequence that a map is made of.
enum class Points { kAll, kStatic };

/// The map of every second scan.
OccupancyMap map_of(const Sequence& sequence, Points which) {
  OccupancyMap map(0.2);
  for (std::size_t i = 0; i < sequence.scans->size(); i += 2) {
    const Scan scan = sequence.scans->load(i);
    std::vector<std::uint32_t> labels;
    if (which == Points::kStatic) labels = sequence.labels->labels(scan);
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const float range = scan.points[k].norm();
      if (range < kNearest || range > kFarthest) continue;
      if (!labels.empty() && sequence.label_rule.classify(labels[k]) == LabelClass::kMoving) {
        continue;
      }
      map.insert(map.voxel_of(scan.T_world_sensor * scan.points[k].cast<double>()));
    }
  }
  map.update_boxes(1);
  return map;
}

void add_workloads(const std::string& name, const std::string& path, bool with_trails,
                   std::vector<std::unique_ptr<Workload>>& list) {
  std::fprintf(stderr, "kernels: reading %s (%s)\n", name.c_str(), path.c_str());
  const Sequence sequence = open_sequence(path, {});
  const auto add = [&](const std::string& full_name, Points which) {
    auto workload = std::make_unique<Workload>();
    workload->name = full_name;
    workload->map = map_of(sequence, which);
    if (workload->map.size() == 0) {
      throw DataError(path + ": there is no point within 2.7 .. 50 m to make a map of.");
    }
    const std::size_t count = sequence.scans->size();
    for (const std::size_t view : {count / 6, count / 2, count - 1 - count / 6}) {
      workload->views.push_back(sequence.scans->pose(view));
    }
    list.push_back(std::move(workload));
  };
  const bool labelled = sequence.labels != nullptr;
  add(name, labelled ? Points::kStatic : Points::kAll);
  if (labelled && with_trails) add(name + "_with_trails", Points::kAll);
}

}  // namespace

AngularGrid paper_grid() {
  return {720, 450, -25.8 * kDegree, 3.0 * kDegree};
}

const std::vector<std::unique_ptr<Workload>>& workloads() {
  static const auto all = [] {
    std::vector<std::unique_ptr<Workload>> list;
    const char* data = std::getenv("RAYMOVAL_DATA");
    if (data != nullptr && *data != '\0') add_workloads("drive", data, true, list);
    add_workloads("simulated", "town:scans=60", false, list);
    return list;
  }();
  return all;
}

}  // namespace raymoval::kernels_bench
