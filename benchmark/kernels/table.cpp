// SPDX-License-Identifier: MIT
#include "benchmark/kernels/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"

namespace raymoval::kernels_bench {
namespace {

using Json = nlohmann::json;

/// The median of one benchmark on one workload, or why there is none.
struct Timed {
  std::string kernel, workload;
  double milliseconds = 0.0;  ///< Per iteration.
  std::map<std::string, double> counters;
  std::string error;

  [[nodiscard]] bool casts_images() const { return counters.contains("images_per_iteration"); }
  /// Milliseconds per image or scan, if an iteration has several.
  [[nodiscard]] double each() const {
    double count = 1.0;
    for (const char* name : {"images_per_iteration", "scans_per_iteration"}) {
      const auto found = counters.find(name);
      if (found != counters.end()) count = found->second;
    }
    return milliseconds / count;
  }
  [[nodiscard]] std::string counter(const char* name, int digits) const {
    const auto found = counters.find(name);
    return found == counters.end() ? "" : fmt::format("{:.{}f}", found->second, digits);
  }
};

/// Whether a record represents all repetitions: their median, a single repetition, or a failure.
bool is_summary(const Json& run) {
  if (run.value("error_occurred", false)) return run.value("repetition_index", 0) == 0;
  if (run.value("run_type", "") == "aggregate") return run.at("aggregate_name") == "median";
  return run.value("repetitions", 1) <= 1;
}

Timed timed_of(const Json& run) {
  Timed timed;
  // "kernel/workload" with additions of Google Benchmark.
  const std::string name = run.at("run_name");
  const std::size_t slash = name.find('/');
  timed.kernel = name.substr(0, slash);
  timed.workload = name.substr(slash + 1, name.find('/', slash + 1) - slash - 1);
  timed.error = run.value("error_message", "");
  if (!timed.error.empty()) return timed;
  const std::string unit = run.at("time_unit");
  const double scale = unit == "ns" ? 1e-6 : unit == "us" ? 1e-3 : unit == "ms" ? 1.0 : 1e3;
  // Other programs hardly change the processor time of one thread; for several threads it has no
  // meaning.
  const bool threaded = timed.kernel.ends_with("_2_threads") || timed.kernel.ends_with("line_2");
  timed.milliseconds = run.at(threaded ? "real_time" : "cpu_time").get<double>() * scale;
  for (const auto& [key, value] : run.items()) {
    if (value.is_number()) timed.counters[key] = value.get<double>();
  }
  return timed;
}

std::vector<Timed> read_all(const std::vector<std::string>& json_files) {
  std::vector<Timed> all;
  for (const std::string& path : json_files) {
    try {
      for (const Json& run : Json::parse(read_text(path)).at("benchmarks")) {
        if (is_summary(run)) all.push_back(timed_of(run));
      }
    } catch (const Json::exception& error) {
      throw DataError(
          fmt::format("{}: this is not the JSON of Google Benchmark ({}).", path, error.what()));
    }
  }
  return all;
}

/// First-hit images, the slowest first.
std::string image_table(std::vector<Timed> images) {
  std::stable_sort(images.begin(), images.end(), [](const Timed& a, const Timed& b) {
    return a.workload != b.workload ? a.workload < b.workload : a.each() > b.each();
  });
  std::map<std::string, double> yardsticks;
  for (const Timed& image : images) {
    if (image.kernel == "dense_bitset_dda") yardsticks[image.workload] = image.each();
  }
  std::string text =
      "\n## First-hit images\n\n| map | kernel | ms an image, median | times as fast as "
      "dense_bitset_dda | steps a ray | bins off by 1 mm |\n"
      "| --- | --- | ---: | ---: | ---: | ---: |\n";
  for (const Timed& image : images) {
    text += fmt::format("| {} | {} | {:.3f} | {:.2f} | {} | {} |\n", image.workload, image.kernel,
                        image.each(), yardsticks[image.workload] / image.each(),
                        image.counter("steps_per_ray", 1), image.counter("bins_off_by_1_mm", 0));
  }
  return text;
}

/// Everything else: the stages of a scan and the maps by size.
std::string other_table(const std::vector<Timed>& others) {
  std::string text =
      "\n## Scans and maps\n\n| kernel | sequence, or voxels of the map | ms an iteration or a "
      "scan, median | stages, ms of wall time | ns an operation | bytes a voxel |\n"
      "| --- | --- | ---: | --- | ---: | ---: |\n";
  for (const Timed& other : others) {
    if (!other.error.empty()) {
      text += fmt::format("| {} | {} | | {} | | |\n", other.kernel, other.workload, other.error);
      continue;
    }
    std::string stages;
    for (const auto& [key, value] : other.counters) {
      if (!key.starts_with("ms_")) continue;
      stages += fmt::format("{}{} {:.2f}", stages.empty() ? "" : ", ", key.substr(3), value);
    }
    const auto operation = other.counters.find("per_operation");
    text += fmt::format(
        "| {} | {} | {:.3f} | {} | {} | {} |\n", other.kernel, other.workload, other.each(), stages,
        operation == other.counters.end() ? "" : fmt::format("{:.1f}", operation->second * 1e9),
        other.counter("bytes_per_voxel", 2));
  }
  return text;
}

}  // namespace

std::string tables_of(const std::vector<std::string>& json_files) {
  std::vector<Timed> all = read_all(json_files);
  const auto others = std::stable_partition(
      all.begin(), all.end(), [](const Timed& timed) { return timed.casts_images(); });
  return "# Kernels\n\nMedians of processor time; of wall time where two threads are at work.\n" +
         image_table({all.begin(), others}) + other_table({others, all.end()});
}

}  // namespace raymoval::kernels_bench
