// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/sparse_objects.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// The least share of the directions into its box, seen from the side, from which an object has
/// points.
constexpr double kLeastDense = 0.03;

}  // namespace

bool is_sparse(const ObjectSummary& object, const DirectionSteps& steps) {
  const double area = object.width() * (object.high.z() - object.low.z());
  const double area_of_each =
      static_cast<double>(object.range) * object.range * steps.azimuth * steps.elevation;
  return area_of_each > 0.0 && object.points * area_of_each < kLeastDense * area;
}

}  // namespace raymoval::raymoval_plus_method
