// SPDX-License-Identifier: MIT
#include "benchmark/kernels/series.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"

namespace raymoval::kernels_bench {
namespace {

using Json = nlohmann::json;

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void remember(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// "kernel/workload", without what Google Benchmark adds to it.
std::pair<std::string, std::string> names_of(const Json& run) {
  std::string name = run.at("run_name");
  const std::size_t fixed = name.find("/iterations:");
  if (fixed != std::string::npos) name.resize(fixed);
  const std::size_t slash = name.find('/');
  return {name.substr(0, slash), slash == std::string::npos ? "" : name.substr(slash + 1)};
}

/// Other programs hardly change the processor time of one thread; where several are at work it says
/// nothing.
void add_times(const Json& run, const std::string& kernel, Series& series) {
  const std::string unit = run.at("time_unit");
  const double scale = unit == "ns" ? 1e-6 : unit == "us" ? 1e-3 : unit == "ms" ? 1.0 : 1e3;
  const bool threaded = kernel.ends_with("_2_threads") || kernel.ends_with("line_2");
  series.wall.push_back(run.at("real_time").get<double>() * scale);
  series.milliseconds.push_back(threaded ? series.wall.back()
                                         : run.at("cpu_time").get<double>() * scale);
}

void add_runs(const Json& file, Results& results) {
  for (const Json& run : file.at("benchmarks")) {
    if (run.value("run_type", "iteration") != "iteration") continue;
    const auto [kernel, workload] = names_of(run);
    remember(results.kernels, kernel);
    remember(results.workloads, workload);
    Series& series = results.series[{kernel, workload}];
    if (run.value("error_occurred", false)) {
      series.error = run.value("error_message", "failed");
      continue;
    }
    add_times(run, kernel, series);
    for (const auto& [key, value] : run.items()) {
      if (value.is_number()) series.counters[key] = value.get<double>();
    }
  }
}

}  // namespace

double Series::median() const {
  return median_of(milliseconds);
}

double Series::wall_median() const {
  return median_of(wall);
}

double Series::counter(const std::string& name, double otherwise) const {
  const auto found = counters.find(name);
  return found == counters.end() ? otherwise : found->second;
}

const Series* Results::find(const std::string& kernel, const std::string& workload) const {
  const auto found = series.find({kernel, workload});
  return found == series.end() ? nullptr : &found->second;
}

Results read_results(const std::vector<std::string>& json_files) {
  Results results;
  for (const std::string& path : json_files) {
    std::ifstream file(path);
    try {
      add_runs(Json::parse(file), results);
    } catch (const Json::exception& error) {
      throw DataError(path + ": this is not the JSON of Google Benchmark (" + error.what() + ").");
    }
  }
  return results;
}

std::string number(double value, int digits) {
  return fixed_text(value, digits);
}

}  // namespace raymoval::kernels_bench
