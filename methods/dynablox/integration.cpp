// SPDX-License-Identifier: MIT
#include "methods/dynablox/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/angle.h"
#include "core/parallel.h"

namespace raymoval::dynablox_method {
namespace {

constexpr std::size_t kPointsAtOnce = 16384;
constexpr std::size_t kBlocksAtOnce = 4;

/// The blocks within reach of a sensor, as flags.
class BlocksAround {
 public:
  /// @param sensor in blocks
  BlocksAround(const Eigen::Vector3d& sensor, int reach)
      : lowest_(voxel_index(sensor, 1.0).array() - reach),
        side_(2 * reach + 1),
        sensor_(sensor - lowest_.cast<double>()) {
    const auto side = static_cast<std::size_t>(side_);
    flags_.assign(side * side * side, 0);
  }
  /// Marks the blocks that a ray passes through.
  /// @param ahead unit vector
  /// @param reach in blocks, at least one less than the reach of this object
  void mark_ray(const Eigen::Vector3d& ahead, double reach) {
    mark(sensor_.cast<int>());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (ahead[axis] == 0.0) continue;
      // Each wall across this axis in turn, with the block behind it.
      const double delta = 1.0 / std::abs(ahead[axis]);
      const int step = ahead[axis] > 0.0 ? 1 : -1;
      int behind = static_cast<int>(sensor_[axis]);
      const double inside = sensor_[axis] - behind;
      for (double way = (step > 0 ? 1.0 - inside : inside) * delta; way <= reach; way += delta) {
        behind += step;
        // All coordinates are positive, so that truncation rounds down.
        VoxelIndex at = (sensor_ + way * ahead).cast<int>();
        at[axis] = behind;
        mark(at);
      }
    }
  }
  void add(const BlocksAround& other) {
    for (std::size_t i = 0; i < flags_.size(); ++i) flags_[i] |= other.flags_[i];
  }
  /// Calls `visit(at)` for each marked block in order of z, y, x.
  template <class Visit>
  void for_each(Visit&& visit) const {
    std::size_t i = 0;
    for (int z = 0; z < side_; ++z) {
      for (int y = 0; y < side_; ++y) {
        for (int x = 0; x < side_; ++x) {
          if (flags_[i++] != 0) visit(VoxelIndex(lowest_ + VoxelIndex(x, y, z)));
        }
      }
    }
  }

 private:
  void mark(const VoxelIndex& at) {
    flags_[static_cast<std::size_t>((at.z() * side_ + at.y()) * side_ + at.x())] = 1;
  }

  VoxelIndex lowest_;
  int side_;
  Eigen::Vector3d sensor_;  ///< From the corner of the lowest block.
  std::vector<std::uint8_t> flags_;
};

/// A scan's rays.
struct Rays {
  const Scan& scan;
  const Parameters& parameters;
  double max_range = 0.0;  ///< Metres.
  double edge = 0.0;       ///< Of a block, metres.

  /// Marks the blocks that a point's ray passes through, within the range of updates.
  void mark(const Eigen::Vector3f& point, BlocksAround& blocks) const {
    const Eigen::Vector3d ahead = point.cast<double>();
    const double range = ahead.norm();
    if (!(range >= parameters.min_range && range > 0.0) || range > max_range) return;
    const double reach = (range + parameters.truncation) / edge;
    blocks.mark_ray(scan.T_world_sensor.linear() * (ahead / range), reach);
  }
};

/// Tests whether a box is completely above or below the image, so that no voxel of it is updated.
class ViewCones {
 public:
  explicit ViewCones(const ImageGrid& grid) {
    // A little wider than the image, for rounding.
    const double half_row = 0.51 / grid.rows_per_radian + 1e-4;
    const double low = grid.elevation_min - half_row;
    const float rows_above = static_cast<float>(grid.rows - 1);
    const double high = grid.elevation_min + rows_above / grid.rows_per_radian + half_row;
    // The region above a rising cone, or below a falling one, is convex.
    has_low_ = low < 0.0 && low > -kTurn / 4.0;
    has_high_ = high > 0.0 && high < kTurn / 4.0;
    low_slope_ = static_cast<float>(std::tan(low));
    high_slope_ = static_cast<float>(std::tan(high));
  }
  /// @param corners of a convex body, sensor frame
  template <std::size_t count>
  [[nodiscard]] bool hide(const std::array<Eigen::Vector3f, count>& corners) const {
    bool below = has_low_, above = has_high_;
    for (const Eigen::Vector3f& p : corners) {
      const float level = std::sqrt(p.x() * p.x() + p.y() * p.y());
      below = below && p.z() < low_slope_ * level;
      above = above && p.z() > high_slope_ * level;
    }
    return below || above;
  }

 private:
  bool has_low_ = false, has_high_ = false;
  float low_slope_ = 0.0F, high_slope_ = 0.0F;
};

/// The integration of one scan into layers.
class LayerUpdate {
 public:
  LayerUpdate(const Scan& scan, double voxel_size, const kernels::Integration& job,
              const ImageGrid& grid, const kernels::Kernels& kernels)
      : T_sensor_world_(scan.T_world_sensor.inverse()),
        voxel_size_(voxel_size),
        job_(job),
        cones_(grid),
        kernels_(kernels) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      job_.along_x[axis] = static_cast<float>(T_sensor_world_.linear()(k, 0) * voxel_size);
      job_.along_y[axis] = static_cast<float>(T_sensor_world_.linear()(k, 1) * voxel_size);
    }
  }

  void update(Block& block, std::unique_ptr<Layer>& spare) const {
    for (int z = 0; z < kSide; ++z) {
      const VoxelIndex first(block.at.x() * kSide, block.at.y() * kSide, block.at.z() * kSide + z);
      const Eigen::Vector3f centre = in_sensor_frame(first);
      if (cones_.hide(corners(centre))) continue;
      std::unique_ptr<Layer>& layer = block.layers[static_cast<std::size_t>(z)];
      const bool is_new = layer == nullptr;
      if (is_new && spare == nullptr) spare = std::make_unique<Layer>();
      Layer& fields = is_new ? *spare : *layer;
      const kernels::LayerFields job{
          {centre.x(), centre.y(), centre.z()}, fields.distance.data(), fields.weight.data()};
      if (!kernels_.integrate(job_, job) || !is_new) continue;
      fields.last_occupied.fill(block.unseen_last_occupied);
      fields.occupied_scans.fill(block.unseen_occupied_scans);
      layer = std::move(spare);
    }
  }

 private:
  /// The centre of a voxel, metres.
  [[nodiscard]] Eigen::Vector3f in_sensor_frame(const VoxelIndex& voxel) const {
    const Eigen::Vector3d world = (voxel.cast<double>().array() + 0.5).matrix() * voxel_size_;
    return (T_sensor_world_ * world).cast<float>();
  }
  /// The centres of a layer's four voxels at its corners.
  [[nodiscard]] std::array<Eigen::Vector3f, 4> corners(const Eigen::Vector3f& first) const {
    const float steps = kSide - 1;
    const Eigen::Vector3f x = steps * Eigen::Vector3f(job_.along_x.data());
    const Eigen::Vector3f y = steps * Eigen::Vector3f(job_.along_y.data());
    return {first, first + x, first + y, first + x + y};
  }

  Pose T_sensor_world_;
  double voxel_size_;
  kernels::Integration job_;
  ViewCones cones_;
  kernels::Kernels kernels_;
};

/// The smaller of the sensor's range and `max_range`; `max_range` if the sensor's range is unknown.
double range_of(const Parameters& parameters, const SensorModel& sensor) {
  if (!(sensor.range_max > 0.0)) return parameters.max_range;
  return std::min(parameters.max_range, sensor.range_max);
}

/// The number of steps in `whole`; the published number if the step is unknown.
int steps_in(double whole, double step, int published, int most) {
  if (!(step > 0.0)) return published;
  return static_cast<int>(std::clamp(std::round(whole / step), 1.0, static_cast<double>(most)));
}

}  // namespace

ImageGrid::ImageGrid(const SensorModel& sensor) {
  constexpr double kPublishedView = 33.22 * kDegree;
  constexpr int kMostColumns = 16384, kMostRows = 1024;
  double low = -0.5 * kPublishedView, high = -low;
  const auto is_elevation = [](double angle) { return std::abs(angle) <= kTurn / 4.0; };
  if (is_elevation(sensor.elevation_min) && is_elevation(sensor.elevation_max) &&
      sensor.elevation_min < sensor.elevation_max) {  // Not if one is unknown.
    low = sensor.elevation_min;
    high = std::max(sensor.elevation_max, low + kDegree);
  }
  columns = steps_in(kTurn, sensor.azimuth_step, columns, kMostColumns);
  rows = 1 + steps_in(high - low, sensor.elevation_step, rows - 1, kMostRows);
  columns_per_radian = static_cast<float>(columns / kTurn);
  rows_per_radian = static_cast<float>((rows - 1) / (high - low));
  elevation_min = static_cast<float>(low);
  pixels_per_square_radian = static_cast<float>(columns / kTurn * rows / (high - low));
}

Integrator::Integrator(const Parameters& parameters, const SensorModel& sensor)
    : parameters_(parameters),
      max_range_(range_of(parameters, sensor)),
      kernels_(kernels::best_kernels()),
      grid_(sensor) {}

void Integrator::integrate(const Scan& scan, const RunContext& context, BlockMap& map,
                           std::vector<Block*>& touched) {
  {
    const StageScope timed(context.times, "rays");
    fill_image(scan);
    touch_blocks(scan, context, map, touched);
  }
  const StageScope timed(context.times, "integration");
  update(scan, context, touched);
}

/// Replaces the image of the previous scan. Returns nearer than `min_range` are left out.
void Integrator::fill_image(const Scan& scan) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const kernels::Projection job{.columns = grid_.columns,
                                .rows = grid_.rows,
                                .columns_per_radian = grid_.columns_per_radian,
                                .rows_per_radian = grid_.rows_per_radian,
                                .elevation_min = grid_.elevation_min,
                                .min_range = static_cast<float>(parameters_.min_range)};
  const std::size_t lanes = kernels_.most_lanes, points = scan.size();
  const std::size_t whole = points - points % lanes;
  pixels_.resize(whole + lanes);
  ranges_.resize(whole + lanes);
  if (whole > 0) {
    kernels_.project(job, scan.points.front().data(), whole, pixels_.data(), ranges_.data());
  }
  // The rest, padded with points at the origin, which are in no pixel.
  std::vector<Eigen::Vector3f> rest(scan.points.begin() + static_cast<std::ptrdiff_t>(whole),
                                    scan.points.end());
  rest.resize(lanes, Eigen::Vector3f::Zero());
  kernels_.project(job, rest.front().data(), lanes, pixels_.data() + whole, ranges_.data() + whole);
  image_.assign(grid_.stored(0, grid_.rows + 1), 0.0F);
  for (std::size_t k = 0; k < points; ++k) {
    if (pixels_[k] < 0) continue;
    float& nearest = image_[static_cast<std::size_t>(pixels_[k])];
    nearest = nearest == 0.0F ? ranges_[k] : std::min(nearest, ranges_[k]);
  }
  for (int row = 0; row < grid_.rows; ++row) {
    image_[grid_.stored(grid_.columns, row)] = image_[grid_.stored(0, row)];
  }
}

void Integrator::touch_blocks(const Scan& scan, const RunContext& context, BlockMap& map,
                              std::vector<Block*>& touched) const {
  const Rays rays{scan, parameters_, max_range_, kSide * parameters_.voxel_size};
  const double longest = max_range_ + parameters_.truncation;
  const int reach = static_cast<int>(std::ceil(longest / rays.edge)) + 1;
  BlocksAround all(scan.T_world_sensor.translation() / rays.edge, reach);
  std::vector<BlocksAround> parts((scan.size() + kPointsAtOnce - 1) / kPointsAtOnce, all);
  parallel_chunks(context.threads, scan.size(), kPointsAtOnce,
                  [&](std::size_t begin, std::size_t end) {
                    BlocksAround& part = parts[begin / kPointsAtOnce];
                    for (std::size_t k = begin; k < end; ++k) rays.mark(scan.points[k], part);
                  });
  for (const BlocksAround& part : parts) all.add(part);
  touched.clear();
  all.for_each([&](const VoxelIndex& at) { touched.push_back(&map.find_or_make(at, at)); });
}

void Integrator::update(const Scan& scan, const RunContext& context,
                        const std::vector<Block*>& touched) const {
  const double area = parameters_.voxel_size * parameters_.voxel_size;
  const kernels::Integration job{
      .image = image_.data(),
      .columns = grid_.columns,
      .last_row = static_cast<float>(grid_.rows - 1),
      .columns_per_radian = grid_.columns_per_radian,
      .rows_per_radian = grid_.rows_per_radian,
      .elevation_min = grid_.elevation_min,
      .min_range = static_cast<float>(parameters_.min_range),
      .max_range = static_cast<float>(max_range_),
      .rays_at_a_metre = static_cast<float>(area * grid_.pixels_per_square_radian),
      .voxel_size = static_cast<float>(parameters_.voxel_size),
      .truncation = static_cast<float>(parameters_.truncation),
      .max_weight = static_cast<float>(parameters_.max_weight)};
  const LayerUpdate layers(scan, parameters_.voxel_size, job, grid_, kernels_);
  parallel_chunks(context.threads, touched.size(), kBlocksAtOnce,
                  [&](std::size_t begin, std::size_t end) {
                    std::unique_ptr<Layer> spare;
                    for (std::size_t i = begin; i < end; ++i) layers.update(*touched[i], spare);
                  });
}

}  // namespace raymoval::dynablox_method
