// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "tests/methods/erasor/scenes.h"

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

const std::vector<std::string> kSets = {"kitti00", "kitti01", "kitti02", "kitti05", "kitti07"};

double value_of(const std::string& variant, const std::string& name) {
  const auto method = MethodRegistry::built_in().configure("erasor:" + variant);
  for (const auto& [known, value] : method.configuration) {
    if (known != name) continue;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    return static_cast<double>(std::get<std::int64_t>(value));
  }
  FAIL("no parameter " + name);
  return 0.0;
}

}  // namespace

TEST_CASE("the authors' sets are theirs, and the general one is their median", "[erasor]") {
  // Values of 2021 in the order 00, 01, 02, 05, 07.
  const std::map<std::string, std::vector<double>> published = {
      {"max_range", {80, 60, 80, 60, 80}},
      {"num_rings", {20, 15, 20, 15, 20}},
      {"num_sectors", {108, 108, 108, 60, 108}},
      {"min_h", {-1.3, -1.3, -0.8, -1.3, -0.8}},
      {"max_h", {3.0, 3.0, 2.0, 3.2, 3.1}},
      {"th_bin_max_h", {0.2, 0.2, 0.2, 0.05, 0.2}},
      {"scan_ratio_threshold", {0.2, 0.2, 0.2, 0.3, 0.2}},
      {"minimum_num_pts", {6, 6, 6, 10, 6}},
      {"gf_dist_thr", {0.15, 0.15, 0.15, 0.15, 0.125}},
      {"gf_num_lpr", {20, 10, 20, 10, 10}},
      {"num_lowest_pts", {5, 5, 5, 5, 1}},
      {"removal_interval", {4, 1, 5, 8, 5}},
      {"map_voxel_size", {0.2, 0.2, 0.2, 0.2, 0.2}},
      {"query_voxel_size", {0.2, 0.2, 0.2, 0.2, 0.2}},
      {"sensor_height", {1.73, 1.73, 1.73, 1.73, 1.73}},
      {"min_range", {2.7, 2.7, 2.7, 2.7, 2.7}},
      {"gf_th_seeds_height", {0.5, 0.5, 0.5, 0.5, 0.5}},
      {"gf_iter", {3, 3, 3, 3, 3}},
      {"version", {3, 3, 3, 3, 3}},
  };
  for (const auto& [name, values] : published) {
    INFO(name);
    for (std::size_t i = 0; i < kSets.size(); ++i) CHECK(value_of(kSets[i], name) == values[i]);
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    CHECK(value_of("general", name) == sorted[2]);
  }
  CHECK(MethodRegistry::built_in().configure("erasor").variant.name == "general");
}

}  // namespace raymoval::erasor_test
