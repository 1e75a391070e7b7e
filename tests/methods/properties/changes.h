// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "tests/methods/properties/random_world.h"

namespace raymoval::toy {

struct Place {
  std::size_t scan, point;
};

/// A world after a change, and where its points are now.
struct ChangedWorld {
  HeldScans scans;
  /// By scan of the world before, and by point of it. Scans that are gone are left out; they are
  /// the last ones.
  std::vector<std::vector<Place>> now;
  std::vector<std::pair<Place, Place>> twins = {};  ///< Points of `scans` in the same place.
};

/// A change of the input of a method.
struct Change {
  const char* name;
  ChangedWorld (*make)(const HeldScans& world, std::mt19937& random);
};

/// All changes, in the order of the columns of `claims`.
const std::vector<Change>& changes();

/// The same scans with other names and intensities, and other times if `other_times`, of which a
/// method must take no notice.
HeldScans with_other_labels(const HeldScans& world, bool other_times);

}  // namespace raymoval::toy
