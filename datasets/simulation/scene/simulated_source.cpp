// SPDX-License-Identifier: MIT
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/simulated.h"
#include "datasets/simulation/sensor/last_values.h"
#include "datasets/simulation/sensor/pose_noise.h"
#include "datasets/simulation/sensor/scanner.h"
#include "datasets/simulation/world/world.h"

namespace raymoval {
namespace {

using simulated::Mover;
using simulated::Scanner;
using simulated::SensorFile;
using simulated::Sweep;
using simulated::World;
using simulated::WorldFile;

std::string six_digits(std::size_t number) {
  std::string text = std::to_string(number);
  return text.size() < 6 ? std::string(6 - text.size(), '0') + text : text;
}

/// `pose` without pitch and roll, so that z of a world frame anchored to it is up.
Pose level(const Pose& pose) {
  constexpr double kVertical = 0.999;
  Eigen::Vector3d x = pose.linear().col(0);
  // A sensor that looks down or up: its z axis has the heading.
  if (std::abs(x.z()) > kVertical) x = -x.z() * pose.linear().col(2);
  const double yaw = std::atan2(x.y(), x.x());
  Pose result = Pose::Identity();
  result.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  result.translation() = pose.translation();
  return result;
}

/// T_sequence_world of a sequence that begins with the sensor at `first`.
Pose sequence_frame(const SimulationOptions& options, const Pose& first) {
  const Pose levelled = level(first).inverse();
  if (options.turned_deg == 0.0 && options.tilted_deg == 0.0) return levelled;
  const Eigen::AngleAxisd turn(-options.turned_deg * kDegree, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd tilt(-options.tilted_deg * kDegree, Eigen::Vector3d::UnitX());
  Pose result = Pose::Identity();
  result.linear() = (tilt * turn).toRotationMatrix();
  return result * levelled;
}

class Simulation final : public SimulatedSequence {
 public:
  Simulation(const SimulationOptions& options, WorldFile file, SensorFile sensor, int threads)
      : file_(std::move(file)),
        sensor_(std::move(sensor)),
        model_(sensor_.model()),
        count_(options.scans > 0 ? options.scans : static_cast<std::size_t>(file_.scans)),
        world_(file_, options.seed, static_cast<double>(count_ - 1) * sensor_.period_s),
        scanner_(
            world_, sensor_, [this](double t) { return world_.ego()->sensor_pose(t); },
            {options.seed, options.rolling, options.noise_free}, threads),
        anchor_(sequence_frame(options, world_.ego()->usual_sensor_pose(0.0))),
        errors_(simulated::pose_errors({}, options.pose_noise, count_, sensor_.period_s,
                                       options.seed)) {
    std::size_t whole = 0;
    while (whole < count_ && world_.ego()->on_route(time(whole))) ++whole;
    if (whole < count_) {
      throw UsageError(file_.name + ": the sensor's route ends after " + std::to_string(whole) +
                       " scans, but " + std::to_string(count_) +
                       " were asked for. Ask for fewer, or make the route longer or closed.");
    }
  }

  [[nodiscard]] std::size_t size() const override { return count_; }
  [[nodiscard]] const SensorModel& sensor() const override { return model_; }
  [[nodiscard]] const std::string& name() const override { return file_.name; }
  [[nodiscard]] const std::string& sensor_name() const override { return sensor_.name; }
  [[nodiscard]] double scan_period_s() const override { return sensor_.period_s; }
  [[nodiscard]] RangeLimits range_m() const override {
    return {file_.range_m.low, file_.range_m.high};
  }
  [[nodiscard]] const World& world() const override { return world_; }
  [[nodiscard]] Pose T_sequence_world() const override { return anchor_; }

  [[nodiscard]] Pose true_pose(std::size_t scan) const override {
    return anchor_ * world_.ego()->sensor_pose(time(scan));
  }
  [[nodiscard]] Pose pose(std::size_t scan) const override {
    check(scan);
    return true_pose(scan) * errors_[scan];
  }

  [[nodiscard]] Scan load(std::size_t index) const override {
    check(index);
    Sweep sweep = scanner_.sweep(index);
    Scan scan;
    scan.index = index;
    scan.name = six_digits(index);
    scan.time_s = time(index);
    scan.T_world_sensor = pose(index);
    scan.points = std::move(sweep.points);
    scan.reflectance = std::move(sweep.reflectance);
    scan.stored_point_count = scan.points.size();
    memory_.keep(index, std::move(sweep.labels));
    return scan;
  }

  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    check(scan.index);
    const auto kept = memory_.find(scan.index);
    std::vector<std::uint32_t> labels = kept ? *kept : scanner_.sweep(scan.index).labels;
    if (labels.size() != scan.size()) {
      throw DataError(file_.name + ": scan " + std::to_string(scan.index) + " has " +
                      grouped_text(labels.size()) + " points, but labels were asked for one of " +
                      grouped_text(scan.size()) + ". Ask with the scan as it was loaded.");
    }
    return labels;
  }

  [[nodiscard]] std::vector<MoverTruth> movers(double time_s) const override {
    std::vector<MoverTruth> truths;
    for (const auto& mover : world_.movers()) {
      truths.push_back({mover->instance(), static_cast<std::uint16_t>(mover->label() & 0xFFFFU),
                        mover->kind(), mover->moves(), mover->present(time_s),
                        anchor_ * mover->pose(time_s), mover->track().speed(time_s)});
    }
    return truths;
  }

 private:
  [[nodiscard]] double time(std::size_t scan) const {
    return static_cast<double>(scan) * sensor_.period_s;
  }
  void check(std::size_t scan) const {
    if (scan < count_) return;
    throw UsageError(file_.name + ": there is no scan " + std::to_string(scan) +
                     ", the sequence has " + std::to_string(count_) + ".");
  }

  WorldFile file_;
  SensorFile sensor_;
  SensorModel model_;
  std::size_t count_;
  World world_;
  Scanner scanner_;
  Pose anchor_;
  std::vector<Pose> errors_;
  mutable simulated::LastValues<std::vector<std::uint32_t>> memory_{8};  ///< Labels.
};

}  // namespace

std::shared_ptr<const SimulatedSequence> make_simulated(const SimulationOptions& options,
                                                        int threads) {
  if (!(options.pose_noise >= 0.0 && options.pose_noise <= 1000.0)) {
    throw UsageError("the severity of pose noise is " + number_text(options.pose_noise) +
                     ", expected 0 (perfect) to 1000; 1 is a good LiDAR odometry.");
  }
  for (const auto& [name, angle] : options.angles()) {
    if (std::abs(angle) <= 360.0) continue;
    throw UsageError("the angle '" + name + "' of a simulation is " + number_text(angle) +
                     " degrees, expected -360 to 360.");
  }
  if (options.scans > 1'000'000) throw UsageError("a simulation has at most 1,000,000 scans.");
  WorldFile world = simulated::parse_world(simulated::find_world(options.scene));
  world.ego.mount = {options.roll_deg, options.pitch_deg, options.yaw_deg};
  world.ego.mount *= kDegree;
  const std::string sensor = options.sensor.empty() ? world.sensor : options.sensor;
  return std::make_shared<Simulation>(
      options, std::move(world), simulated::parse_sensor(simulated::find_sensor(sensor)), threads);
}

}  // namespace raymoval
