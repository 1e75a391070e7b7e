// SPDX-License-Identifier: MIT
#include "datasets/simulation/street/street.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "core/angle.h"
#include "core/error.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/settings.h"
#include "datasets/simulation/sensor/last_values.h"

namespace raymoval {
namespace {

using Eigen::Vector3d;

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kRoad = 40;
constexpr const char* kStreet = "street";

constexpr std::uint32_t label_word(std::uint32_t semantic, std::uint32_t instance) {
  return (instance << 16U) | semantic;
}

/// Distance along `direction` to the ground z = 0.
double ground_range(const Vector3d& origin, const Vector3d& direction) {
  return direction.z() < 0.0 ? -origin.z() / direction.z() : kNothing;
}

/// Distance along `direction` to the box, by the slab method: the ray is inside if it is between
/// both planes of each axis at once. `origin` is outside.
double box_range(const Vector3d& origin, const Vector3d& direction, const Vector3d& min,
                 const Vector3d& max) {
  double enter = 0.0, leave = kNothing;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (origin[axis] < min[axis] || origin[axis] > max[axis]) return kNothing;
      continue;
    }
    const double a = (min[axis] - origin[axis]) / direction[axis];
    const double b = (max[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
    if (enter > leave) return kNothing;
  }
  return enter > 0.0 ? enter : kNothing;
}

struct Return {
  Eigen::Vector3f point;
  std::uint32_t label;
};

/// The scans of the sensor in the world, frame by frame.
class StreetScene {
 public:
  StreetScene(const StreetParameters& parameters, std::vector<StreetBox> boxes)
      : parameters_(parameters), boxes_(std::move(boxes)) {
    const SensorModel model = sensor();
    for (int beam = 0; beam < parameters_.beams; ++beam) {
      const double elevation = model.elevation_min + beam * model.elevation_step;
      for (int column = 0; column < parameters_.columns; ++column) {
        const double azimuth = -std::numbers::pi + column * model.azimuth_step;
        directions_.emplace_back(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      }
    }
  }

  [[nodiscard]] double time(std::size_t frame) const {
    return static_cast<double>(frame) * parameters_.scan_period_s;
  }
  [[nodiscard]] Vector3d position(std::size_t frame) const {
    return {static_cast<double>(frame) * parameters_.metres_per_scan, 0.0,
            parameters_.sensor_height};
  }

  /// Returns of a frame, beam by beam from the lowest, each a full turn counter-clockwise.
  [[nodiscard]] std::vector<Return> cast(std::size_t frame) const {
    const Vector3d origin = position(frame);
    const auto boxes = boxes_at(time(frame));
    std::vector<Return> returns;
    for (const Vector3d& direction : directions_) {
      const auto [range, label] = first_hit(origin, direction, boxes);
      if (range > parameters_.range_max) continue;
      returns.push_back({(range * direction).cast<float>(), label});
    }
    return returns;
  }

  [[nodiscard]] SensorModel sensor() const {
    SensorModel model;
    model.name = "street";
    model.azimuth_step = 2.0 * std::numbers::pi / parameters_.columns;
    model.elevation_min = parameters_.elevation_min_deg * kDegree;
    model.elevation_max = parameters_.elevation_max_deg * kDegree;
    model.elevation_step =
        (model.elevation_max - model.elevation_min) / std::max(1, parameters_.beams - 1);
    model.range_min = 0.0;
    model.range_max = parameters_.range_max;
    model.missing_return_is_meaningful = true;
    return model;
  }

 private:
  [[nodiscard]] std::vector<StreetBox> boxes_at(double time_s) const {
    std::vector<StreetBox> boxes = boxes_;
    for (StreetBox& box : boxes) {
      box.min += box.velocity * time_s;
      box.max += box.velocity * time_s;
    }
    return boxes;
  }

  static std::pair<double, std::uint32_t> first_hit(const Vector3d& origin,
                                                    const Vector3d& direction,
                                                    const std::vector<StreetBox>& boxes) {
    std::pair<double, std::uint32_t> hit{ground_range(origin, direction), kRoad};
    for (const StreetBox& box : boxes) {
      const double range = box_range(origin, direction, box.min, box.max);
      if (range < hit.first) hit = {range, box.label};
    }
    return hit;
  }

  StreetParameters parameters_;
  std::vector<StreetBox> boxes_;
  std::vector<Vector3d> directions_;  ///< Unit vectors, beam by beam.
};

class StreetScans : public ScanSource, public LabelSource {
 public:
  StreetScans(StreetScene scene, std::vector<std::size_t> frames,
              const std::optional<std::string>& sensor)
      : scene_(std::move(scene)), frames_(std::move(frames)), ideal_(scene_.sensor()) {
    if (sensor) choice_ = std::make_unique<SensorChoice>(sensor);
  }

  [[nodiscard]] std::size_t size() const override { return frames_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    const std::size_t frame = frames_.at(index);
    Scan scan;
    scan.index = index;
    scan.name = std::to_string(frame);
    scan.name.insert(0, 6 - std::min<std::size_t>(6, scan.name.size()), '0');
    scan.time_s = scene_.time(frame);
    scan.T_world_sensor = pose(index);
    const auto returns = returns_of(frame);
    scan.points.reserve(returns->size());
    for (const Return& hit : *returns) scan.points.push_back(hit.point);
    scan.stored_point_count = scan.points.size();
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    return Pose(Eigen::Translation3d(scene_.position(frames_.at(index))));
  }
  [[nodiscard]] const SensorModel& sensor() const override {
    if (!choice_) return ideal_;
    return choice_->get(size(), [this](std::size_t index) { return load(index); });
  }
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    std::vector<std::uint32_t> words;
    const auto returns = returns_of(frames_.at(scan.index));
    words.reserve(returns->size());
    for (const Return& hit : *returns) words.push_back(hit.label);
    if (words.size() != scan.stored_point_count) {
      throw InternalError("scan " + scan.name + " is not one of this street");
    }
    return of_kept_points(scan, std::move(words));
  }

 private:
  using Returns = std::vector<Return>;

  /// Returns of a frame. Casting takes longer than all other work on so small a scene, so the last
  /// frames are kept: at most 64, of 16 MiB.
  [[nodiscard]] std::shared_ptr<const Returns> returns_of(std::size_t frame) const {
    const auto kept = kept_.find(frame);
    return kept ? kept : kept_.keep(frame, scene_.cast(frame));
  }

  StreetScene scene_;
  std::vector<std::size_t> frames_;
  SensorModel ideal_;
  std::unique_ptr<SensorChoice> choice_;  ///< Set if the user gave another sensor.
  mutable simulated::LastValues<Returns> kept_{64};
};

void check_parameters(const StreetParameters& p) {
  const bool sensible = p.scans > 0 && p.beams > 0 && p.columns > 0 && p.sensor_height > 0.0 &&
                        p.scan_period_s > 0.0 && p.range_max > 0.0 &&
                        p.elevation_min_deg >= -90.0 && p.elevation_max_deg <= 90.0 &&
                        p.elevation_min_deg <= p.elevation_max_deg;
  if (!sensible) {
    throw UsageError(
        "street: scans, beams, columns, sensor_height, scan_period_s and range_max "
        "have to be above 0, and elevations within -90 to 90 degrees.");
  }
}

}  // namespace

std::vector<StreetBox> street_boxes() {
  const Vector3d still = Vector3d::Zero();
  return {
      {{-70, 8, 0}, {130, 8.5, 6}, still, label_word(50, 0)},
      {{-70, -8.5, 0}, {130, -8, 6}, still, label_word(50, 0)},
      {{20, 6, 0}, {20.2, 6.2, 5}, still, label_word(80, 0)},
      {{36, -6.2, 0}, {36.2, -6, 5}, still, label_word(80, 0)},
      {{26, 4.2, 0}, {30.2, 6, 1.5}, still, label_word(10, 3)},
      // Oncoming at 8 m/s; it passes the sensor (10 m/s) after about 3.3 s.
      {{58, -3.9, 0}, {62.2, -2.1, 1.5}, {-8, 0, 0}, label_word(252, 1)},
      // Crosses ahead from right to left, and is 2.5 m to the left when the sensor is level.
      {{41.75, -5.25, 0}, {42.25, -4.75, 1.75}, {0, 1.8, 0}, label_word(254, 2)},
  };
}

Sequence make_street(const StreetParameters& parameters, const std::vector<StreetBox>& boxes,
                     const SequenceOptions& options) {
  check_parameters(parameters);
  if (options.poses) {
    throw UsageError("street: the built-in scene has its own poses; leave --poses out.");
  }
  SequenceSettings defaults;
  defaults.name = kStreet;
  defaults.source = "built-in procedural scene";
  defaults.scan_period_s = parameters.scan_period_s;
  const SequenceSettings settings = apply_options(options, defaults);
  const std::string given = settings.points ? "--points" : first_pose_setting(settings);
  if (!given.empty()) {
    throw UsageError("street: " + given + " cannot be used on a scene in memory. Leave it out.");
  }

  std::vector<NumberedFile> all;
  for (std::size_t i = 0; i < parameters.scans; ++i) all.push_back({static_cast<long>(i), {}});
  const ChosenFrames chosen = choose_frames(all, settings.frames, "street");
  std::vector<std::size_t> frames;
  for (const NumberedFile& file : chosen.files) {
    frames.push_back(static_cast<std::size_t>(file.number));
  }

  Sequence sequence = make_sequence(settings, street_layout(), chosen.range);
  const auto street = std::make_shared<const StreetScans>(StreetScene(parameters, boxes),
                                                          std::move(frames), settings.sensor);
  sequence.poses_file = "exact";
  sequence.labels = street;
  sequence.scans = street;
  return sequence;
}

Layout street_layout() {
  const auto its_name = [] { return std::vector<std::string>{kStreet}; };
  const auto sequence_name = [](Layout::Path) { return std::string(kStreet); };
  // It has no options to distinguish it from a folder.
  const auto unmistakable = [](Layout::Path) {
    return std::string("start where there is no such folder");
  };
  Layout layout;
  layout.name = "simulated";
  layout.expected = "'street', the built-in scene";
  layout.forms = {{kStreet, "small built-in scene, needs no data"}};
  layout.class_names = semantickitti_class_names();
  layout.recognise = [](Layout::Path path) { return path == kStreet; };
  layout.open = [](Layout::Path, const SequenceOptions& options, const OpenContext&) {
    return make_street({}, street_boxes(), options);
  };
  layout.scenes = SceneNames{its_name, sequence_name, unmistakable};
  return layout;
}

}  // namespace raymoval
