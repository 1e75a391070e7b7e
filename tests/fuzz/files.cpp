// SPDX-License-Identifier: MIT
// Files beside the scans, and files that users write.
#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmark/suite/suite.h"
#include "core/files/files.h"
#include "core/scan/label_rule.h"
#include "datasets/clouds/poses.h"
#include "datasets/settings.h"
#include "datasets/simulation/sensor/sensor_file.h"
#include "datasets/simulation/world/world.h"
#include "datasets/simulation/world/world_file.h"
#include "datasets/trajectories/body_sensor.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

RAYMOVAL_FUZZ_TARGET(poses) {
  may_refuse([&] {
    const PoseFile file = read_pose_file(input_file("poses.txt", bytes));
    for (std::size_t row = 0; row < file.rows.size(); ++row) {
      may_refuse([&] {
        const Eigen::Matrix3d rotation = rigid_pose(file, row).linear();
        const auto off = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
        require(off.norm() < 1e-9, "a pose is not rigid");
      });
    }
  });
}

RAYMOVAL_FUZZ_TARGET(calibration) {
  may_refuse([&] {
    const Pose pose = read_calibration(input_file("calib.txt", bytes), "Tr");
    require(pose.matrix().allFinite(), "a calibration is not finite");
  });
}

RAYMOVAL_FUZZ_TARGET(times) {
  may_refuse([&] {
    const StampColumn column = read_stamp_file(input_file("times.txt", bytes));
    require(column.stamps.size() == column.since_first.size(), "a time is lost");
    for (const double time : column.since_first) {
      require(std::isfinite(time), "a time is not finite");
    }
  });
}

RAYMOVAL_FUZZ_TARGET(sequence_json) {
  const auto path = input_file("sequence.json", bytes);
  may_refuse([&] {
    const SequenceSettings settings = read_settings(path.parent_path(), {}, {});
    require(settings.range_m.min < settings.range_m.max, "a range is empty");
    require(!settings.name.empty(), "a sequence has no name");
  });
}

RAYMOVAL_FUZZ_TARGET(label_rule) {
  may_refuse([&] {
    const nlohmann::json json = read_json(input_file("rule.json", bytes));
    const LabelRule rule = label_rule_from_json(json, {}, "rule.json");
    for (const std::uint16_t id : rule.moving) {
      require(rule.classify(id) == LabelClass::kMoving, "a moving label does not move");
    }
    for (const std::uint16_t id : rule.ignored) {
      require(rule.classify(id) == LabelClass::kIgnored, "an ignored label is not ignored");
    }
  });
}

RAYMOVAL_FUZZ_TARGET(suite) {
  may_refuse([&] {
    const auto path = input_file("suite.json", bytes);
    Suite suite = read_suite(path, MethodRegistry::built_in());
    require(!suite.sequences.empty() && !suite.methods.empty(), "a suite is empty");
    add_controls(suite, MethodRegistry::built_in());
    for (const MethodRequest& request : suite.methods) {
      require(folder_name(request.name).find('/') == std::string::npos,
              "a cell's folder has a slash");
      (void)to_json(request.method.configuration).dump();
    }
  });
}

RAYMOVAL_FUZZ_TARGET(world) {
  may_refuse([&] {
    const nlohmann::json json = read_json(input_file("world.json", bytes));
    const simulated::WorldFile world = simulated::world_from_json(json, "world.json");
    require(!world.roads.empty(), "a world has no road");
  });
}

RAYMOVAL_FUZZ_TARGET(sensor) {
  may_refuse([&] {
    const nlohmann::json json = read_json(input_file("sensor.json", bytes));
    const simulated::SensorFile sensor = simulated::sensor_from_json(json, "sensor.json");
    const SensorModel model = sensor.model();
    require(std::isfinite(model.azimuth_step) && std::isfinite(model.elevation_step) &&
                std::isfinite(model.elevation_max) && std::isfinite(model.range_max),
            "a sensor model is not finite");
  });
}

}  // namespace
}  // namespace raymoval::fuzz
