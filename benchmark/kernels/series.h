// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace raymoval::kernels_bench {

/// Repetitions of one benchmark on one workload (or map size).
struct Series {
  std::vector<double> milliseconds;  ///< An iteration each.
  std::vector<double> wall;          ///< The same by the clock on the wall.
  std::map<std::string, double> counters;
  std::string error;

  /// Median of `milliseconds`: processor time of one thread, wall time where several are at work.
  [[nodiscard]] double median() const;
  [[nodiscard]] double wall_median() const;
  [[nodiscard]] double counter(const std::string& name, double otherwise) const;
};

/// By workload, then by kernel, in order of first appearance.
struct Results {
  std::vector<std::string> workloads, kernels;
  std::map<std::pair<std::string, std::string>, Series> series;

  /// Null where the kernel did not run on the workload.
  [[nodiscard]] const Series* find(const std::string& kernel, const std::string& workload) const;
};

/// Reads files of Google Benchmark's JSON. @throws DataError
Results read_results(const std::vector<std::string>& json_files);

/// `value` with so many digits after the point.
std::string number(double value, int digits);

}  // namespace raymoval::kernels_bench
