// SPDX-License-Identifier: MIT
#include "benchmark/kernels/table.h"

#include <algorithm>

#include "benchmark/kernels/goals.h"
#include "benchmark/kernels/series.h"

namespace raymoval::kernels_bench {
namespace {

/// Kernels that ran on a workload.
std::vector<std::string> slowest_first(const Results& results, const std::string& workload) {
  std::vector<std::pair<double, std::string>> timed;
  for (const std::string& kernel : results.kernels) {
    const Series* series = results.find(kernel, workload);
    if (series == nullptr || series->milliseconds.empty()) continue;
    timed.emplace_back(-series->median(), kernel);
  }
  std::sort(timed.begin(), timed.end());
  std::vector<std::string> names;
  for (const auto& [time, name] : timed) names.push_back(name);
  return names;
}

std::string image_table(const Results& results, const std::string& workload) {
  const Series* yardstick = results.find("dense_bitset_dda", workload);
  if (yardstick == nullptr || yardstick->milliseconds.empty()) return "";
  std::string text = "\n## First-hit images, " + workload + "\n\n" +
                     "| kernel | ms an image, median | times as fast as dense_bitset_dda | steps a "
                     "ray | bins off by 1 mm |\n| --- | ---: | ---: | ---: | ---: |\n";
  for (const std::string& kernel : slowest_first(results, workload)) {
    const Series* series = results.find(kernel, workload);
    if (series->counter("images_per_iteration", 0.0) == 0.0) continue;
    const double steps = series->counter("steps_per_ray", 0.0);
    const double off = series->counter("bins_off_by_1_mm", -1.0);
    text += "| " + kernel + " | " +
            number(series->median() / series->counter("images_per_iteration", 1.0), 3) + " | " +
            number(yardstick->median() / series->median(), 2) + " | " +
            (steps > 0.0 ? number(steps, 1) : "") + " | " + (off < 0.0 ? "" : number(off, 0)) +
            " |\n";
  }
  return text;
}

std::string scan_table(const Results& results) {
  std::string text;
  for (const std::string& kernel : results.kernels) {
    for (const std::string& workload : results.workloads) {
      const Series* series = results.find(kernel, workload);
      if (series == nullptr || series->milliseconds.empty()) continue;
      if (kernel.rfind("map_", 0) == 0 || series->counters.contains("images_per_iteration")) {
        continue;
      }
      std::string stages;
      for (const auto& [key, value] : series->counters) {
        if (key.rfind("ms_", 0) != 0) continue;
        stages += (stages.empty() ? "" : ", ") + key.substr(3) + " " + number(value, 2);
      }
      text += "| " + kernel + " | " + workload + " | " +
              number(series->median() / series->counter("scans_per_iteration", 1.0), 3) + " | " +
              stages + " |\n";
    }
  }
  if (text.empty()) return "";
  return "\n## Scans\n\n| kernel | sequence | ms a scan, median | of which, wall time |\n| --- | "
         "--- | ---: | "
         "--- |\n" +
         text;
}

std::string map_table(const Results& results) {
  std::string text;
  for (const std::string& size : results.workloads) {
    const auto cell = [&](const char* kernel, bool per_operation) -> std::string {
      const Series* series = results.find(kernel, size);
      if (series == nullptr) return "";
      if (series->milliseconds.empty()) return series->error;
      return per_operation ? number(series->median() * 1e6 / 25000.0, 1)
                           : number(series->median(), 3);
    };
    const Series* any = results.find("map_insert", size);
    if (any == nullptr) continue;
    text += "| " + size + " | " + cell("map_insert", true) + " | " + cell("map_erase", true) +
            " | " + cell("map_lookup", true) + " | " + cell("map_upkeep", false) + " | " +
            cell("map_image", false) + " | " + number(any->counter("bytes_per_voxel", 0.0), 2) +
            " |\n";
  }
  if (text.empty()) return "";
  return "\n## Maps by size\n\n| voxels | insert, ns | erase, ns | look up, ns | boxes after "
         "25,000 "
         "insertions, ms | image, ms | bytes a voxel |\n| ---: | ---: | ---: | ---: | ---: | ---: "
         "| "
         "---: |\n" +
         text;
}

}  // namespace

std::string tables_of(const std::vector<std::string>& json_files) {
  const Results results = read_results(json_files);
  std::string text =
      "# Kernels\n\nMedians of processor time; of wall time where two threads are at work.\n";
  text += goals_table(results);
  for (const std::string& workload : results.workloads) text += image_table(results, workload);
  return text + scan_table(results) + map_table(results);
}

}  // namespace raymoval::kernels_bench
