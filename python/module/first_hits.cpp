// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/first_hit.h"

#include <pybind11/stl.h>

#include <bit>
#include <cmath>
#include <mutex>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "python/module/arrays.h"
#include "python/module/bindings.h"

namespace raymoval::python {
namespace {

using raymoval_method::AngularGrid;
using raymoval_method::Brick;
using raymoval_method::FirstHitCaster;
using raymoval_method::FirstHitImage;
using raymoval_method::OccupancyMap;
using raymoval_method::RayLimits;

/// A map that threads may share. A thread releases the GIL before it waits for the mutex.
struct HeldMap {
  explicit HeldMap(double voxel_size) : map(voxel_size) {}
  OccupancyMap map;
  std::mutex mutex;
};

std::shared_ptr<HeldMap> make_map(double voxel_size) {
  if (voxel_size >= 1e-4 && voxel_size <= 1e4) return std::make_shared<HeldMap>(voxel_size);
  throw UsageError("voxel_size " + number_text(voxel_size) +
                   ": expected metres from 0.0001 to 10,000.");
}

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// World points as N x 3 numbers. @throws UsageError
Doubles world_points(const py::array& given) {
  const char kind = given.dtype().kind();
  if (given.ndim() != 2 || given.shape(1) != 3 || (kind != 'f' && kind != 'i' && kind != 'u')) {
    throw UsageError("points have the shape " + shape_text(given) + " and the type " +
                     std::string(py::str(given.dtype())) +
                     ", expected (N, 3) numbers in the world frame, metres.");
  }
  return given;
}

/// Calls `use(i, voxel)` for the voxel of each point.
template <class Use>
void for_each_voxel(HeldMap& held, const Doubles& points, Use&& use) {
  const double* data = points.data();
  const auto count = static_cast<std::size_t>(points.shape(0));
  const py::gil_scoped_release without_gil;
  const std::lock_guard lock(held.mutex);
  for (std::size_t i = 0; i < count; ++i) {
    use(i, held.map.voxel_of({data[3 * i], data[3 * i + 1], data[3 * i + 2]}));
  }
}

std::size_t insert(HeldMap& held, const py::array& given) {
  std::size_t added = 0;
  for_each_voxel(held, world_points(given), [&](std::size_t, const VoxelIndex& voxel) {
    added += held.map.insert(voxel) ? 1 : 0;
  });
  return added;
}

std::size_t erase(HeldMap& held, const py::array& given) {
  std::size_t removed = 0;
  for_each_voxel(held, world_points(given), [&](std::size_t, const VoxelIndex& voxel) {
    removed += held.map.erase(voxel) ? 1 : 0;
  });
  return removed;
}

py::array_t<bool> contains(HeldMap& held, const py::array& given) {
  Mask inside(static_cast<std::size_t>(given.ndim() > 0 ? given.shape(0) : 0));
  for_each_voxel(held, world_points(given), [&](std::size_t i, const VoxelIndex& voxel) {
    inside[i] = held.map.contains(voxel) ? 1 : 0;
  });
  return array_of(inside);
}

void add_voxels(const OccupancyMap::BrickHead& head, const Brick& brick,
                std::vector<std::int32_t>& voxels) {
  for (int x = 0; x < Brick::kSide; ++x) {
    for (std::uint64_t word = brick.occupied[static_cast<std::size_t>(x)]; word != 0;
         word &= word - 1) {
      const int bit = std::countr_zero(word);
      voxels.push_back(head.at[0] * Brick::kSide + x);
      voxels.push_back(head.at[1] * Brick::kSide + bit / Brick::kSide);
      voxels.push_back(head.at[2] * Brick::kSide + bit % Brick::kSide);
    }
  }
}

/// Sorted by z, y and x.
py::array_t<std::int32_t> voxels_of(HeldMap& held) {
  std::vector<std::int32_t> voxels;
  {
    const py::gil_scoped_release without_gil;
    const std::lock_guard lock(held.mutex);
    held.map.update_boxes(1);
    for (std::size_t tile = 0; tile < held.map.tile_count(); ++tile) {
      for (const OccupancyMap::BrickHead& head : held.map.tile(tile)) {
        add_voxels(head, held.map.brick(head.slot), voxels);
      }
    }
  }
  return py::array_t<std::int32_t>({static_cast<py::ssize_t>(voxels.size() / 3), py::ssize_t{3}},
                                   voxels.data());
}

AngularGrid make_grid(int azimuth, int elevation, double elevation_min, double elevation_max) {
  constexpr int kMost = 1 << 14;
  constexpr double kUp = std::numbers::pi / 2.0;
  const bool is_count = azimuth >= 4 && azimuth <= kMost && elevation >= 1 && elevation <= kMost;
  if (!is_count || !(elevation_min < elevation_max && elevation_min >= -kUp - 1e-9 &&
                     elevation_max <= kUp + 1e-9)) {
    throw UsageError("bins " + std::to_string(azimuth) + " x " + std::to_string(elevation) +
                     " from " + number_text(elevation_min) + " to " + number_text(elevation_max) +
                     " rad: expected 4 to 16,384 of azimuth and 1 to 16,384 of elevation, and "
                     "-pi/2 <= elevation_min < elevation_max <= pi/2.");
  }
  return {azimuth, elevation, elevation_min, elevation_max};
}

bool are_equal(const AngularGrid& a, const AngularGrid& b) {
  return a.azimuth_bins == b.azimuth_bins && a.elevation_bins == b.elevation_bins &&
         a.elevation_min == b.elevation_min && a.elevation_max == b.elevation_max;
}

/// Casts images of one map. The tables of the bins used last are kept.
class HeldCaster {
 public:
  HeldCaster(std::shared_ptr<HeldMap> map, double minimum_range, double maximum_range, int threads)
      : map_(std::move(map)),
        limits_{minimum_range, maximum_range},
        threads_(threads > 0 ? threads : hardware_threads()) {
    if (minimum_range >= 0.0 && minimum_range < maximum_range && maximum_range <= 1e4) return;
    throw UsageError("ranges " + number_text(minimum_range) + " to " + number_text(maximum_range) +
                     " m: expected 0 <= minimum_range < maximum_range <= 10,000.");
  }
  py::array_t<float> cast(const py::object& given, const AngularGrid& bins) {
    const Pose pose = pose_from(given, "pose");
    py::array_t<float> image({bins.elevation_bins, bins.azimuth_bins});
    float* ranges = image.mutable_data();
    const py::gil_scoped_release without_gil;
    const std::lock_guard lock(map_->mutex);
    if (!caster_ || !are_equal(grid_, bins)) {
      caster_.emplace(bins, limits_);
      grid_ = bins;
    }
    caster_->cast(map_->map, pose, threads_, image_);
    std::copy(image_.range.begin(), image_.range.end(), ranges);
    return image;
  }

 private:
  std::shared_ptr<HeldMap> map_;
  RayLimits limits_;
  int threads_;
  AngularGrid grid_;
  std::optional<FirstHitCaster> caster_;
  FirstHitImage image_;
};

void bind_map(py::module_& module) {
  py::class_<HeldMap, std::shared_ptr<HeldMap>>(
      module, "OccupancyMap",
      "Occupied voxels of the world in sparse bricks of 8 x 8 x 8, a bit each. Voxel k of an axis "
      "holds the coordinates from k to k + 1 times `voxel_size`.")
      .def(py::init(&make_map), py::arg("voxel_size"))
      .def("insert", &insert, py::arg("points"),
           "Adds the voxels of world points (N x 3, metres). Returns how many are new.")
      .def("erase", &erase, py::arg("points"),
           "Removes the voxels of world points (N x 3, metres). Returns how many were there.")
      .def("contains", &contains, py::arg("points"),
           "N bool: whether the voxel of each world point (N x 3, metres) is occupied.")
      .def("voxels", &voxels_of, "M x 3 int32: the indices of all occupied voxels.")
      .def_property_readonly(
          "voxel_size", [](const HeldMap& held) { return held.map.voxel_size(); },
          "The edge of a voxel, metres.")
      .def_property_readonly(
          "memory_bytes",
          [](HeldMap& held) {
            const py::gil_scoped_release without_gil;
            const std::lock_guard lock(held.mutex);
            return held.map.memory_bytes();
          },
          "The memory of all that it holds.")
      .def("__len__", [](HeldMap& held) {
        const py::gil_scoped_release without_gil;
        const std::lock_guard lock(held.mutex);
        return held.map.size();
      });
}

}  // namespace

void bind_first_hits(py::module_& module) {
  bind_map(module);
  py::class_<AngularGrid>(
      module, "Bins",
      "Directions around a sensor: the azimuth covers the full circle from -pi "
      "on, the elevation goes from `elevation_min` to `elevation_max`, radians.")
      .def(py::init(&make_grid), py::arg("azimuth") = 720, py::arg("elevation") = 450,
           py::arg("elevation_min") = -0.4363, py::arg("elevation_max") = 0.0524)
      .def_readonly("azimuth", &AngularGrid::azimuth_bins, "Number of columns.")
      .def_readonly("elevation", &AngularGrid::elevation_bins, "Number of rows.")
      .def_readonly("elevation_min", &AngularGrid::elevation_min)
      .def_readonly("elevation_max", &AngularGrid::elevation_max)
      .def(
          "direction",
          [](const AngularGrid& bins, int row, int column) {
            if (row < 0 || row >= bins.elevation_bins || column < 0 ||
                column >= bins.azimuth_bins) {
              throw py::index_error("there is no such bin");
            }
            const Eigen::Vector3d unit = bins.direction(row * bins.azimuth_bins + column);
            return py::array_t<double>(3, unit.data());
          },
          py::arg("row"), py::arg("column"), "Unit vector of a bin's centre in the sensor frame.");
  py::class_<HeldCaster>(module, "FirstHitCaster",
                         "Casts rays into a map: the image of what a sensor would see first.")
      .def(py::init<std::shared_ptr<HeldMap>, double, double, int>(), py::arg("map").none(false),
           py::arg("minimum_range") = 0.0, py::arg("maximum_range") = 60.0, py::arg("threads") = 0)
      .def("cast", &HeldCaster::cast, py::arg("pose"), py::arg("bins"),
           "The range at which the ray of each bin first enters an occupied voxel, metres: a row "
           "for each elevation, from below, a column for each azimuth; float32, infinite where "
           "nothing is hit. `pose` is T_world_sensor, 4 x 4.");
}

}  // namespace raymoval::python
