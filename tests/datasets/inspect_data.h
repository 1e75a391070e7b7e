// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "datasets/inspection/inspect.h"
#include "datasets/simulation/scene/simulated.h"
#include "datasets/world_axes/up_direction.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {

/// A sequence in memory that a test may damage at will.
struct EditedSequence : ScanSource, LabelSource {
  std::vector<Scan> scans;
  std::vector<std::vector<std::uint32_t>> words;
  SensorModel model;
  RangeLimits range_m;
  bool labelled = true;
  std::optional<Eigen::Vector3d> up;  ///< What a user says.
  std::vector<std::string> damage, losses;

  /// Every `step`-th scan of a simulated drive.
  explicit EditedSequence(const SimulationOptions& options, std::size_t step = 1) {
    const auto simulated = make_simulated(options, 2);
    for (std::size_t i = 0; i < simulated->size(); i += step) {
      scans.push_back(simulated->load(i));
      words.push_back(simulated->labels(scans.back()));
      scans.back().index = i / step;
    }
    model = simulated->sensor();
    range_m = simulated->range_m();
  }

  [[nodiscard]] std::size_t size() const override { return scans.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override { return scans.at(index); }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    return scans.at(index).T_world_sensor;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return model; }
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    return words.at(scan.index);
  }

  void each_pose(const std::function<Pose(const Pose&)>& change) {
    for (Scan& scan : scans) scan.T_world_sensor = change(scan.T_world_sensor);
  }
  void each_point(const std::function<Eigen::Vector3d(const Scan&, const Eigen::Vector3d&)>& to) {
    for (Scan& scan : scans) {
      for (Eigen::Vector3f& p : scan.points) p = to(scan, p.cast<double>()).cast<float>();
    }
  }
  /// Leaves out points, with their labels.
  void keep(const std::function<bool(const Eigen::Vector3f&)>& kept) {
    for (Scan& scan : scans) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < scan.size(); ++i) {
        if (!kept(scan.points[i])) continue;
        scan.points[count] = scan.points[i];
        scan.reflectance[count] = scan.reflectance[i];
        words[scan.index][count++] = words[scan.index][i];
      }
      scan.points.resize(count);
      scan.reflectance.resize(count);
      words[scan.index].resize(count);
      scan.stored_point_count = count;
    }
  }

  [[nodiscard]] InspectionReport inspected() const {
    const auto self = std::shared_ptr<const EditedSequence>(this, [](const EditedSequence*) {});
    Sequence sequence;
    sequence.name = "edited";
    sequence.layout = "simulated";
    sequence.scans = self;
    if (labelled) sequence.labels = self;
    sequence.label_rule.ignored = {0, 1};
    sequence.range_m = range_m;
    sequence.damage = damage;
    sequence.losses = losses;
    sequence.up_choice = std::make_shared<UpChoice>(up);
    return inspect(sequence);
  }
};

/// A sensor that is shipped, with another step between its azimuths: what a check needs to see, in
/// a part of the time.
inline std::string sensor_with_step(const std::string& sensor, const std::string& step_deg) {
  static const TemporaryFolder folder;
  std::string text = simulated_sensor_text(sensor);
  const std::string key = "\"azimuth_step_deg\": ";
  const std::size_t at = text.find(key);
  REQUIRE(at != std::string::npos);
  text.replace(at, text.find(',', at) - at, key + step_deg);
  return folder.write(sensor + ".json", text).string();
}

inline const std::string& sparse_hdl64e() {
  static const std::string path = sensor_with_step("hdl64e", "1.0368");  // Every sixth.
  return path;
}

inline const std::string& sparse_vlp16() {
  static const std::string path = sensor_with_step("vlp16", "0.4");  // Every second.
  return path;
}

/// A winding street of the suburb, which a car drives along at 6 m/s.
inline SimulationOptions suburb(const std::string& sensor = sparse_vlp16(),
                                std::size_t scans = 16) {
  SimulationOptions options;
  options.scene = "suburb";
  options.sensor = sensor;
  options.scans = scans;
  return options;
}

/// The drive, traced once for all tests.
inline EditedSequence good_drive() {
  static const EditedSequence drive(suburb());
  return drive;
}

inline std::string text_of(const InspectionReport& report) {
  std::string text;
  for (const Finding& finding : report.findings) {
    text += finding.check + ": " + finding.where + ": " + finding.what + "\n";
  }
  for (const auto& [name, value] : report.measures) {
    text += "  " + name + " " + std::to_string(value) + "\n";
  }
  return text;
}

/// The names of the findings, without notes.
inline std::set<std::string> found(const InspectionReport& report) {
  std::set<std::string> names;
  for (const Finding& finding : report.findings) {
    if (finding.severity == Severity::kFinding) names.insert(finding.check);
  }
  return names;
}

/// Exactly `check` was found, in words that say what, where, what was expected and what to do.
inline void check_finds(const InspectionReport& report, const std::string& check,
                        const std::string& remedy = "") {
  INFO(text_of(report));
  REQUIRE(found(report) == std::set<std::string>{check});
  for (const Finding& finding : report.findings) {
    CHECK_FALSE(finding.where.empty());
    CHECK_FALSE(finding.what.empty());
    CHECK_FALSE(finding.expected.empty());
    CHECK_THAT(finding.remedy, Catch::Contains(remedy));
    CHECK_FALSE(finding.remedy.empty());
  }
}

inline void check_silent(const InspectionReport& report) {
  INFO(text_of(report));
  CHECK(report.findings.empty());
}

}  // namespace raymoval::test
