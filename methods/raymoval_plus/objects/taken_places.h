// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "methods/raymoval_plus/objects/object_summary.h"

namespace raymoval::raymoval_plus_method {

/// The boxes of the objects that go, and the scans in which they are there.
class TakenPlaces {
 public:
  void add(std::size_t scan, const ObjectSummary& object);
  /// To be called after the last `add`.
  void sort();
  /// In how many scans one of them fills the place of an object for the most part.
  /// @param slack metres by which boxes may be smaller than things are
  [[nodiscard]] int scans_at(const ObjectSummary& object, double slack) const;

 private:
  struct Place {
    Eigen::Vector3d low, high;
    std::size_t scan;
  };
  std::vector<Place> places_;  ///< Sorted by the lower x.
  double longest_ = 0.0;       ///< The largest extent along x.
};

}  // namespace raymoval::raymoval_plus_method
