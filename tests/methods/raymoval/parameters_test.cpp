// SPDX-License-Identifier: MIT
// The values that the paper prints, ours, what is legal, and what the variants change.
#include <catch2/catch.hpp>
#include <map>

#include "core/text.h"
#include "methods/registry.h"

namespace raymoval::raymoval_test {

namespace {

const MethodEntry& raymoval_entry_of_registry() {
  return *MethodRegistry::built_in().configure("raymoval").entry;
}

/// A parameter's default and its legal values, as in "0.2, 0.02 to 2 m".
std::string default_and_range(const ParameterSpec& spec) {
  const std::string value = parameter_text(spec.default_value);
  if (!spec.choices.empty()) return value + ", " + join(spec.choices);
  if (std::holds_alternative<bool>(spec.default_value)) return value;
  return value + ", " + number_text(spec.notes.minimum) + " to " + number_text(spec.notes.maximum) +
         (spec.notes.unit.empty() ? "" : " " + spec.notes.unit);
}

}  // namespace

TEST_CASE("raymoval's parameters have the paper's values, or ours, and their limits",
          "[raymoval]") {
  const std::map<std::string, std::string> expected = {
      {"azimuth_bins", "720, 0 to 7200 bins"},
      {"elevation_bins", "450, 0 to 3600 bins"},
      {"elevation_margin", "1, 0 to 10 deg"},
      {"voxel_size", "0.2, 0.02 to 2 m"},
      {"maximum_range", "60, 1 to 500 m"},
      {"minimum_range", "2.7, 0 to 20 m"},
      {"neighbourhood", "1, 0 to 10 bins"},
      {"percentile", "0.9, 0 to 1"},
      {"tau0", "0.3, 0 to 10 m"},
      {"tau1", "0.35, 0 to 2"},
      {"erase_tau0", "0.3, 0 to 10 m"},
      {"erase_tau1", "0.1, 0 to 2"},
      {"erase_height", "1, 0 to 10 voxels"},
      {"erase_height_limit", "5, 0 to 100 m"},
      {"erase_percentile", "0.1, 0 to 1"},
      {"erase_azimuth_window", "1, 0 to 30 bins"},
      {"erase_elevation_window", "-1, -1 to 100 bins"},
      {"validate", "true"},
      {"cluster_gap", "0.3, 0.01 to 5 m"},
      {"cluster_gap_growth", "0.02, 0 to 0.2"},
      {"cluster_points", "3, 0 to 1000 points"},
      {"cluster_width", "0, 0 to 5 m"},
      {"group_gap", "1, 1 to 5 voxels"},
      {"coverage_dilation", "1, 0 to 5 voxels"},
      {"coverage_static", "0.95, 0 to 1.01"},
      {"coverage_edge", "0.9, 0 to 1.01"},
      {"thin_side", "0.4, 0 to 5 m"},
      {"support_dilation", "2, 0 to 5 voxels"},
      {"support_share", "0.95, 0 to 1"},
      {"minimum_points", "1, 0 to 1000 points"},
      {"minimum_width", "0, 0 to 5 m"},
      {"offline", "true"},
  };
  std::map<std::string, std::string> found;
  for (const ParameterSpec& spec : raymoval_entry_of_registry().parameters) {
    found[spec.name] = default_and_range(spec);
  }
  CHECK(found == expected);
}

TEST_CASE("raymoval's variants change what their names say", "[raymoval]") {
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"offline", "offline:"},
      {"online", "online: offline=false"},
      {"table1", "offline: erase_tau1=0.35 erase_percentile=0.9"},
      {"table1-online", "online: offline=false erase_tau1=0.35 erase_percentile=0.9"},
  };
  const MethodEntry& entry = raymoval_entry_of_registry();
  std::vector<std::pair<std::string, std::string>> found;
  for (const MethodVariant& variant : entry.variants) {
    std::string told = variant.online ? "online:" : "offline:";
    for (const auto& [name, value] : variant.overrides) {
      told += " " + name + "=" + parameter_text(value);
    }
    found.emplace_back(variant.name, told);
  }
  CHECK(found == expected);
  // The facts that `list`, `describe` and results show.
  CHECK(entry.name == "raymoval");
  CHECK(entry.version == "3");
  CHECK_FALSE(entry.sentence.empty());
  CHECK(entry.source.rfind("Raymoval: ", 0) == 0);
  CHECK(entry.notes.size() == 3);
}

}  // namespace raymoval::raymoval_test
