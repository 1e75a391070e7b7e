// SPDX-License-Identifier: MIT
#include "benchmark/kernels/goals.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace raymoval::kernels_bench {
namespace {

/// Figures of one workload; nothing where a kernel did not run.
class Figures {
 public:
  Figures(const Results& results, std::string workload)
      : results_(results), workload_(std::move(workload)) {}

  [[nodiscard]] std::optional<double> per(const std::string& kernel, const char* unit) const {
    const Series* series = usable(kernel);
    if (series == nullptr) return std::nullopt;
    return series->median() / series->counter(unit, 1.0);
  }
  [[nodiscard]] std::optional<double> image(const std::string& kernel) const {
    return per(kernel, "images_per_iteration");
  }
  [[nodiscard]] std::optional<double> scan(const std::string& kernel) const {
    return per(kernel, "scans_per_iteration");
  }
  /// How many times as fast one kernel is as another, by the clock on the wall.
  [[nodiscard]] std::optional<double> wall_ratio(const std::string& slow,
                                                 const std::string& fast) const {
    const Series* a = usable(slow);
    const Series* b = usable(fast);
    if (a == nullptr || b == nullptr) return std::nullopt;
    return a->wall_median() / b->wall_median();
  }

 private:
  [[nodiscard]] const Series* usable(const std::string& kernel) const {
    const Series* series = results_.find(kernel, workload_);
    return series == nullptr || series->milliseconds.empty() ? nullptr : series;
  }
  const Results& results_;
  std::string workload_;
};

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return std::nullopt;
  return *a / *b;
}

enum class Better { kLower, kHigher };

std::string row(const std::string& what, double goal, double beyond, Better better,
                const char* unit, std::optional<double> value) {
  const auto text = [&](double figure) { return number(figure, figure < 20.0 ? 2 : 0) + unit; };
  const auto reaches = [&](double limit) {
    return better == Better::kLower ? *value <= limit : *value >= limit;
  };
  const char* verdict = !value            ? "not measured"
                        : reaches(beyond) ? "beyond"
                        : reaches(goal)   ? "yes"
                                          : "no";
  const std::string sign = better == Better::kLower ? "at most " : "at least ";
  return "| " + what + " | " + sign + text(goal) + " | " + text(beyond) + " | " +
         (value ? text(*value) : "") + " | " + verdict + " |\n";
}

std::string image_rows(const Figures& at) {
  const auto dense = at.image("dense_bitset_dda");
  const auto octomap = at.image("octomap_cast_ray");
  const auto wide = at.image("first_hit_image_AVX-512"), narrow = at.image("first_hit_image_AVX2");
  return row("image, AVX-512", 3.5, 2.0, Better::kLower, " ms", wide) +
         row("image against dense_bitset_dda, AVX-512", 18, 30, Better::kHigher, "x",
             ratio(dense, wide)) +
         row("image against dense_bitset_dda, AVX2", 14, 20, Better::kHigher, "x",
             ratio(dense, narrow)) +
         row("image against octomap_cast_ray", 180, 300, Better::kHigher, "x",
             ratio(octomap, at.image("first_hit_image")));
}

std::string method_rows(const Figures& at) {
  const auto online = at.scan("raymoval_online_1");
  return row("raymoval:online, all stages, a scan", 10, 6, Better::kLower, " ms", online) +
         row("the same against the same with dense_bitset_dda", 8, 12, Better::kHigher, "x",
             ratio(at.scan("raymoval_online_with_dense_dda"), online)) +
         row("upkeep of its map, a scan", 1, 0.5, Better::kLower, " ms",
             at.scan("raymoval_online_map_upkeep")) +
         row("raymoval:online, two threads against one", 1.7, 1.9, Better::kHigher, "x",
             at.wall_ratio("raymoval_online_1", "raymoval_online_2")) +
         row("raymoval:offline, two threads against one", 1.7, 1.9, Better::kHigher, "x",
             at.wall_ratio("raymoval_offline_1", "raymoval_offline_2"));
}

}  // namespace

std::string goals_table(const Results& results) {
  const auto& names = results.workloads;
  const bool has_drive = std::find(names.begin(), names.end(), "drive") != names.end();
  const std::string workload = has_drive ? "drive" : "simulated";
  const Figures at(results, workload);
  return "\n## Goals, " + workload +
         "\n\n| what | goal | and beyond | measured | reached |\n| --- | ---: | ---: | ---: | --- "
         "|\n" +
         image_rows(at) + method_rows(at) +
         "\nTime a scan at the end of 4,200 scans against the beginning: `raymoval run "
         "simulated-long`, `early` and `late` in its cells.\n";
}

}  // namespace raymoval::kernels_bench
