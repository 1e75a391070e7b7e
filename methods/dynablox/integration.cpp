// SPDX-License-Identifier: MIT
#include "methods/dynablox/integration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
  /// Marks the blocks that a ray goes through.
  /// @param ahead unit vector
  /// @param reach in blocks, at least one less than that of all
  void mark_ray(const Eigen::Vector3d& ahead, double reach) {
    mark(sensor_.cast<int>());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (ahead[axis] == 0.0) continue;
      // Every wall across this axis, one after the other, with the block behind it.
      const double delta = 1.0 / std::abs(ahead[axis]);
      const int step = ahead[axis] > 0.0 ? 1 : -1;
      int behind = static_cast<int>(sensor_[axis]);
      const double inside = sensor_[axis] - behind;
      for (double way = (step > 0 ? 1.0 - inside : inside) * delta; way <= reach; way += delta) {
        behind += step;
        // All coordinates are positive, so that cutting off is rounding down.
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

  /// Marks the blocks that a point's ray goes through, up to where voxels are no longer updated.
  void mark(const Eigen::Vector3f& point, BlocksAround& blocks) const {
    const Eigen::Vector3d ahead = point.cast<double>();
    const double range = ahead.norm();
    if (!(range >= parameters.min_range && range > 0.0)) return;
    if (range > max_range && parameters.clearing != FarReturns::kBlocks) return;
    const double reach = (std::min(range, max_range) + parameters.truncation) / edge;
    blocks.mark_ray(scan.T_world_sensor.linear() * (ahead / range), reach);
  }
};

/// Whether a box is wholly above or below what the image shows, so that no voxel of it is updated.
class ViewCones {
 public:
  explicit ViewCones(const ImageGrid& grid) {
    // A little wider than the image, for roundings.
    const double half_row = 0.51 / grid.rows_per_radian + 1e-4;
    const double low = grid.elevation_min - half_row;
    const float rows_above = static_cast<float>(grid.rows - 1);
    const double high = grid.elevation_min + rows_above / grid.rows_per_radian + half_row;
    // What lies above a rising cone, or below a falling one, is convex.
    has_low_ = low < 0.0 && low > -kernels::kQuarterTurn;
    has_high_ = high > 0.0 && high < kernels::kQuarterTurn;
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

/// One scan on its way into layers.
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
      fields.last_occupied.fill(block.unseen.last_occupied);
      fields.occupied_scans.fill(block.unseen.scans);
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

/// How far the sensor sees and the parameters let it. A sensor whose range is unknown sees so far.
double range_of(const Parameters& parameters, const SensorModel& sensor) {
  if (!(sensor.range_max > 0.0)) return parameters.max_range;
  return std::min(parameters.max_range, sensor.range_max);
}

/// What voxels were before scan `number` makes their block.
Occupation before_first(const Parameters& parameters, std::int32_t number) {
  if (parameters.new_voxels == NewVoxels::kOccupied) return {.scans = 1, .last_occupied = number};
  // Scans are counted from 1 in the public program, and voxels were never occupied in scan 0.
  return {.scans = 0, .last_occupied = -1};
}

/// The lowest and highest row, or part of one, between whose pixels voxels are seen.
std::pair<float, float> rows_seen(const Parameters& parameters, const ImageGrid& grid) {
  const auto last = static_cast<float>(grid.rows - 1);
  if (parameters.interpolation == Interpolation::kAdaptive) return {0.0F, last};
  return {-0.5F, std::nextafter(last + 0.5F, 0.0F)};
}

}  // namespace

Integrator::Integrator(const Parameters& parameters, const SensorModel& sensor)
    : parameters_(parameters),
      max_range_(range_of(parameters, sensor)),
      image_(ImageGrid(parameters, sensor)),
      kernels_(kernels::best_kernels()) {}

void Integrator::integrate(const Scan& scan, const RunContext& context, BlockMap& map,
                           std::vector<Block*>& touched) {
  {
    const StageScope timed(context.times, "rays");
    image_.fill(scan, parameters_, static_cast<float>(max_range_));
    touch_blocks(scan, context, map, touched);
  }
  const StageScope timed(context.times, "integration");
  update(scan, context, touched);
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
  const Occupation of_new = before_first(parameters_, static_cast<std::int32_t>(scan.index));
  all.for_each([&](const VoxelIndex& at) { touched.push_back(&map.find_or_make(at, of_new)); });
}

kernels::Integration Integrator::job() const {
  const ImageGrid& grid = image_.grid();
  const auto [first_row, last_row] = rows_seen(parameters_, grid);
  const double area = parameters_.voxel_size * parameters_.voxel_size;
  return {.image = image_.ranges().data(),
          .columns = grid.columns,
          .first_row = first_row,
          .last_row = last_row,
          .columns_per_radian = grid.columns_per_radian,
          .rows_per_radian = grid.rows_per_radian,
          .elevation_min = grid.elevation_min,
          .min_range = static_cast<float>(parameters_.min_range),
          .max_range = static_cast<float>(max_range_),
          .is_adaptive = parameters_.interpolation == Interpolation::kAdaptive,
          .counts_rays = parameters_.weights == Weights::kRays,
          .rays_at_a_metre = static_cast<float>(area * grid.pixels_per_square_radian),
          .voxel_size = static_cast<float>(parameters_.voxel_size),
          .truncation = static_cast<float>(parameters_.truncation),
          .max_weight = static_cast<float>(parameters_.max_weight)};
}

void Integrator::update(const Scan& scan, const RunContext& context,
                        const std::vector<Block*>& touched) const {
  const LayerUpdate layers(scan, parameters_.voxel_size, job(), image_.grid(), kernels_);
  parallel_chunks(context.threads, touched.size(), kBlocksAtOnce,
                  [&](std::size_t begin, std::size_t end) {
                    std::unique_ptr<Layer> spare;
                    for (std::size_t i = begin; i < end; ++i) layers.update(*touched[i], spare);
                  });
}

}  // namespace raymoval::dynablox_method
