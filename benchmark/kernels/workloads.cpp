// SPDX-License-Identifier: MIT
#include "benchmark/kernels/workloads.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "core/angle.h"
#include "core/error.h"
#include "datasets/open_sequence.h"

namespace raymoval::kernels_bench {
namespace {

constexpr double kNearest = 2.7, kFarthest = 50.0;  // Points of the map, metres from the sensor.

/// The points of a sequence that a map is made of.
enum class Points { kAll, kStatic };

void fill_map(const Sequence& sequence, const HeldSequence& held, Points which, OccupancyMap& map) {
  for (std::size_t i = 0; i < held.scans.size(); i += 2) {
    const Scan& scan = held.scans[i];
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
}

void add_workloads(const std::string& name, const std::string& path, bool with_trails,
                   std::vector<std::unique_ptr<Workload>>& list) {
  std::fprintf(stderr, "kernels: reading %s (%s)\n", name.c_str(), path.c_str());
  const Sequence sequence = open_sequence(path, {});
  const auto held = std::make_shared<HeldSequence>();
  held->sensor = sequence.scans->sensor();
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    held->scans.push_back(sequence.scans->load(i));
    held->points += held->scans.back().size();
  }
  const auto add = [&](const std::string& full_name, Points which) {
    auto workload = std::make_unique<Workload>();
    workload->name = full_name;
    workload->sequence = held;
    fill_map(sequence, *held, which, workload->map);
    if (workload->map.size() == 0) {
      throw DataError(path + ": there is no point within 2.7 .. 50 m to make a map of.");
    }
    const std::size_t count = held->scans.size();
    workload->views = {count / 6, count / 2, count - 1 - count / 6};
    list.push_back(std::move(workload));
  };
  const bool labelled = sequence.labels != nullptr;
  add(name, labelled ? Points::kStatic : Points::kAll);
  if (labelled && with_trails) add(name + "_with_trails", Points::kAll);
}

constexpr int kBlock = 200;  // Cells from one house front to the next: 40 m.
constexpr int kHeight = 40;  // Of the fronts: 8 m.
constexpr double kVoxelsPerCell = 1.0 + kHeight * 2.0 / kBlock;

int city_cells(std::size_t voxels) {
  return static_cast<int>(std::sqrt(static_cast<double>(voxels) / kVoxelsPerCell)) / 2;
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

OccupancyMap city_of(std::size_t voxels) {
  const int reach = city_cells(voxels);
  OccupancyMap map(0.2);
  // Brick by brick, as a drive would fill it.
  for (int bx = -reach; bx < reach; bx += Brick::kSide) {
    for (int by = -reach; by < reach; by += Brick::kSide) {
      for (int x = bx; x < std::min(bx + Brick::kSide, reach); ++x) {
        for (int y = by; y < std::min(by + Brick::kSide, reach); ++y) {
          const bool front =
              std::abs(x) % kBlock == kBlock / 2 || std::abs(y) % kBlock == kBlock / 2;
          for (int z = 0; z < (front ? kHeight : 1); ++z) map.insert({x, y, z - 9});
        }
      }
    }
  }
  map.update_boxes(1);
  return map;
}

double city_reach(std::size_t voxels) {
  return city_cells(voxels) * 0.2;
}

std::size_t available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word) {
    std::size_t kilobytes = 0;
    if (word == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

}  // namespace raymoval::kernels_bench
