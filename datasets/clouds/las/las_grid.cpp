// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/las_grid.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kMost = std::numeric_limits<std::int32_t>::max();
/// Further from 0 than this along an axis, the offset is near the first points, metres. The numbers
/// reach 2,147 km at 0.001 m.
constexpr double kFar = 1e6;

/// The least and the greatest finite coordinates of points; 0 if there are none.
std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds_of(const PointRecords& points) {
  const PositionFields fields = position_fields(points.layout, "points");
  const PointField* axes[] = {&fields.x, &fields.y, &fields.z};
  Eigen::Vector3d least = Eigen::Vector3d::Zero(), most = Eigen::Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    bool any = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double value = points.value(i, *axes[axis]);
      if (!std::isfinite(value)) continue;
      least[axis] = any ? std::min(least[axis], value) : value;
      most[axis] = any ? std::max(most[axis], value) : value;
      any = true;
    }
  }
  return {least, most};
}

}  // namespace

LasGrid::LasGrid(std::string where, const PointRecords& first, const LasNotes* notes)
    : where_(std::move(where)) {
  least_.setConstant(std::numeric_limits<double>::infinity());
  most_ = -least_;
  const auto [least, most] = bounds_of(first);
  if (notes != nullptr) {
    scale_ = notes->scale;
    const auto steps = [&](const Eigen::Vector3d& place) {
      return ((place - notes->offset).array() / scale_.array()).abs().maxCoeff();
    };
    if (steps(least) < kMost && steps(most) < kMost) {
      offset_ = notes->offset;
      return;
    }
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double reach = std::max(std::abs(least[axis]), std::abs(most[axis]));
    const bool far = reach > std::min(kFar, 0.5 * kMost * std::abs(scale_[axis]));
    if (far) offset_[axis] = std::floor(least[axis]);
  }
}

void LasGrid::encode(const Eigen::Vector3d& place, std::uint64_t point, char* to) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double steps = std::nearbyint((place[axis] - offset_[axis]) / scale_[axis]);
    if (!(std::abs(steps) <= kMost)) {
      throw DataError(where_ + ": point " + grouped_text(point) + " has " + "xyz"[axis] + " = " +
                      number_text(place[axis]) + ", but a LAS file with the scale " +
                      number_text(scale_[axis]) + " and the offset " + number_text(offset_[axis]) +
                      " reaches only " + number_text(std::abs(kMost * scale_[axis])) +
                      " m from it, and has no place for what is not finite. Nothing was changed; "
                      "write .pcd or .npy.");
    }
    const auto number = static_cast<std::int32_t>(steps);
    std::memcpy(to + 4 * axis, &number, sizeof number);
    least_[axis] = std::min(least_[axis], steps);
    most_[axis] = std::max(most_[axis], steps);
  }
}

void LasGrid::put_into(std::string& head) const {
  const auto put = [&](std::size_t at, double number) {
    std::memcpy(head.data() + at, &number, sizeof number);
  };
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto place = static_cast<std::size_t>(8 * axis);
    put(131 + place, scale_[axis]);
    put(155 + place, offset_[axis]);
    if (least_[axis] > most_[axis]) continue;
    const double a = least_[axis] * scale_[axis] + offset_[axis];
    const double b = most_[axis] * scale_[axis] + offset_[axis];
    put(179 + 2 * place, std::max(a, b));
    put(187 + 2 * place, std::min(a, b));
  }
}

}  // namespace raymoval
