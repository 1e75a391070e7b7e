// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/text.h"
#include "methods/registry.h"
#include "methods/removert/removert.h"
#include "tests/methods/toy_world.h"

namespace raymoval::removert_test {

using namespace toy;

using Points = std::vector<Eigen::Vector3f>;

/// Scans given point by point, all from the world's origin.
class PointWorld : public HeldScans {
 public:
  explicit PointWorld(const std::vector<Points>& scans) {
    for (const Points& points : scans) add(points);
  }
};

/// Point at a range (metres), an elevation and an azimuth (degrees).
inline Eigen::Vector3f polar(double range, double elevation, double azimuth = 0.0) {
  return (range * direction(azimuth * kDegree, elevation * kDegree)).cast<float>();
}

/// Straight ahead or to the left, plus a tenth of a degree to avoid the pixels' borders.
inline Eigen::Vector3f ahead(double range) {
  return polar(range, 0.1, 0.05);
}
inline Eigen::Vector3f aside(double range) {
  return polar(range, 0.1, 90.05);
}

/// A variant of removert with settings such as {"gamma", "0.1"}.
inline ConfiguredMethod removert(
    const std::string& variant,
    const std::vector<std::pair<std::string, std::string>>& settings = {}) {
  ConfiguredMethod method = MethodRegistry::built_in().configure("removert:" + variant);
  for (const auto& [name, value] : settings) {
    const ParameterSpec& spec = find_parameter("removert", method.entry->parameters, name);
    set_parameter(method.configuration, name, checked_value_from_text("removert", spec, value));
  }
  return method;
}

/// Only the passes named.
inline std::vector<std::pair<std::string, std::string>> passes(const std::vector<double>& remove,
                                                               double revert = 0.0) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (std::size_t i = 0; i < 3; ++i) {
    settings.emplace_back("remove_resolution_" + std::to_string(i + 1),
                          number_text(i < remove.size() ? remove[i] : 0.0));
  }
  settings.emplace_back("revert_resolution_1", number_text(revert));
  return settings;
}

/// Masks of a run as text, such as "10 0": a digit per point, a word per scan.
inline std::string verdicts(const ConfiguredMethod& method, const ScanSource& scans,
                            int threads = 1) {
  const MaskStore masks = masks_of(*method.make(), scans, threads);
  std::string text;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i > 0) text += ' ';
    for (const std::uint8_t removed : masks.get(i)) text += removed != 0 ? '1' : '0';
  }
  return text;
}

}  // namespace raymoval::removert_test
