// SPDX-License-Identifier: MIT
#include "benchmark/kernels/table.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace raymoval::kernels_bench {
namespace {

using Json = nlohmann::json;

/// Repetitions of one benchmark on one workload (or map size).
struct Series {
  std::vector<double> milliseconds;  ///< An iteration each.
  std::map<std::string, double> counters;
  std::string error;

  [[nodiscard]] double median() const {
    std::vector<double> sorted = milliseconds;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
  }
  [[nodiscard]] double counter(const std::string& name, double otherwise) const {
    const auto found = counters.find(name);
    return found == counters.end() ? otherwise : found->second;
  }
};

/// By workload, then by kernel, in order of first appearance.
struct Results {
  std::vector<std::string> workloads, kernels;
  std::map<std::pair<std::string, std::string>, Series> series;

  Series* find(const std::string& kernel, const std::string& workload) {
    const auto found = series.find({kernel, workload});
    return found == series.end() ? nullptr : &found->second;
  }
};

void remember(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Processor time of the one thread, which other programs do not change much; wall time where
/// several threads are at work.
double in_milliseconds(const Json& run) {
  const std::string unit = run.at("time_unit");
  const std::string name = run.at("run_name");
  const bool threaded =
      name.find("2_threads") != std::string::npos || name.find("online_2") != std::string::npos;
  const double scale = unit == "ns" ? 1e-6 : unit == "us" ? 1e-3 : unit == "ms" ? 1.0 : 1e3;
  return run.at(threaded ? "real_time" : "cpu_time").get<double>() * scale;
}

void add_runs(const Json& file, Results& results) {
  for (const Json& run : file.at("benchmarks")) {
    if (run.value("run_type", "iteration") != "iteration") continue;
    std::string name = run.at("run_name");
    const std::size_t fixed = name.find("/iterations:");
    if (fixed != std::string::npos) name.resize(fixed);
    const std::size_t slash = name.find('/');
    const std::string kernel = name.substr(0, slash);
    const std::string workload = slash == std::string::npos ? "" : name.substr(slash + 1);
    remember(results.kernels, kernel);
    remember(results.workloads, workload);
    Series& series = results.series[{kernel, workload}];
    if (run.value("error_occurred", false)) {
      series.error = run.value("error_message", "failed");
      continue;
    }
    series.milliseconds.push_back(in_milliseconds(run));
    for (const auto& [key, value] : run.items()) {
      if (value.is_number()) series.counters[key] = value.get<double>();
    }
  }
}

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

/// Kernels that ran on a workload.
std::vector<std::string> slowest_first(Results& results, const std::string& workload) {
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

std::string image_table(Results& results, const std::string& workload) {
  Series* yardstick = results.find("dense_bitset_dda", workload);
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

std::string scan_table(Results& results) {
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

std::string map_table(Results& results) {
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
  Results results;
  for (const std::string& path : json_files) {
    std::ifstream file(path);
    try {
      add_runs(Json::parse(file), results);
    } catch (const Json::exception& error) {
      throw DataError(path + ": this is not the JSON of Google Benchmark (" + error.what() + ").");
    }
  }
  std::string text =
      "# Kernels\n\nMedians of processor time; of wall time where two threads are at work.\n";
  for (const std::string& workload : results.workloads) text += image_table(results, workload);
  return text + scan_table(results) + map_table(results);
}

}  // namespace raymoval::kernels_bench
