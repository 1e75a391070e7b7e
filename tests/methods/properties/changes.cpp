// SPDX-License-Identifier: MIT
#include "tests/methods/properties/changes.h"

#include <algorithm>
#include <numeric>

#include "tests/methods/moved_world.h"

namespace raymoval::toy {
namespace {

std::size_t index_below(std::size_t count, std::mt19937& random) {
  return random() % count;
}

/// As std::shuffle, which differs from one standard library to another.
std::vector<std::size_t> shuffled(std::size_t count, std::mt19937& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[index_below(i, random)]);
  }
  return order;
}

/// The places of a scan with unchanged points.
std::vector<Place> unmoved(std::size_t scan, std::size_t points) {
  std::vector<Place> places;
  for (std::size_t k = 0; k < points; ++k) places.push_back({scan, k});
  return places;
}

/// Adds an unchanged scan of the original world.
void keep(const Scan& scan, ChangedWorld& changed) {
  changed.now.push_back(unmoved(changed.scans.size(), scan.size()));
  changed.scans.add_scan(scan);
}

Scan without_points(Scan scan) {
  scan.points.clear();
  return scan;
}

ChangedWorld add_empty_last(const HeldScans& world, std::mt19937&) {
  ChangedWorld changed{world, {}};
  for (const Scan& scan : world.scans()) changed.now.push_back(unmoved(scan.index, scan.size()));
  changed.scans.add_scan(without_points(world.scans().back()));
  return changed;
}

ChangedWorld add_empty_between(const HeldScans& world, std::mt19937& random) {
  const std::size_t before = index_below(world.size(), random);
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (const Scan& scan : world.scans()) {
    if (scan.index == before) changed.scans.add_scan(without_points(scan));
    keep(scan, changed);
  }
  return changed;
}

/// The left and the right half, or every second point.
ChangedWorld split(const HeldScans& world, std::mt19937& random) {
  const std::size_t chosen = index_below(world.size(), random);
  const bool by_side = random() % 2 == 0;
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (const Scan& scan : world.scans()) {
    if (scan.index != chosen) {
      keep(scan, changed);
      continue;
    }
    Scan halves[2] = {without_points(scan), without_points(scan)};
    std::vector<Place> places;
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const std::size_t half = by_side ? (scan.points[k].y() > 0.0F ? 1 : 0) : k % 2;
      places.push_back({changed.scans.size() + half, halves[half].size()});
      halves[half].points.push_back(scan.points[k]);
    }
    changed.now.push_back(std::move(places));
    for (Scan& half : halves) changed.scans.add_scan(std::move(half));
  }
  return changed;
}

ChangedWorld shuffle_points(const HeldScans& world, std::mt19937& random) {
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (const Scan& scan : world.scans()) {
    const std::vector<std::size_t> place = shuffled(scan.size(), random);
    Scan other = scan;
    std::vector<Place> places;
    for (std::size_t k = 0; k < scan.size(); ++k) {
      other.points[place[k]] = scan.points[k];
      places.push_back({scan.index, place[k]});
    }
    changed.now.push_back(std::move(places));
    changed.scans.add_scan(std::move(other));
  }
  return changed;
}

/// A fifth of the points of each scan once more, at its end.
ChangedWorld double_points(const HeldScans& world, std::mt19937& random) {
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (const Scan& scan : world.scans()) {
    Scan more = scan;
    for (std::size_t i = 0; i < scan.size() / 5; ++i) {
      const std::size_t k = index_below(scan.size(), random);
      changed.twins.push_back({{scan.index, k}, {scan.index, more.size()}});
      more.points.push_back(scan.points[k]);
    }
    changed.now.push_back(unmoved(scan.index, scan.size()));
    changed.scans.add_scan(std::move(more));
  }
  return changed;
}

/// By whole numbers of 0.05, 0.1, 0.2, 0.4 and 0.8 m, and by quarter turns.
ChangedWorld move(const HeldScans& world, std::mt19937& random) {
  const auto steps = [&random] { return 12.8 * (static_cast<double>(random() % 101) - 50.0); };
  const double x = steps(), y = steps(), z = steps();
  const Pose motion = whole_motion(x, y, z, static_cast<int>(random() % 4));
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (Scan scan : world.scans()) {
    scan.T_world_sensor = motion * scan.T_world_sensor;
    keep(scan, changed);
  }
  return changed;
}

ChangedWorld drop_last(const HeldScans& world, std::mt19937& random) {
  const std::size_t left = 1 + index_below(world.size() - 1, random);
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (std::size_t i = 0; i < left; ++i) keep(world.scans()[i], changed);
  return changed;
}

ChangedWorld shuffle_scans(const HeldScans& world, std::mt19937& random) {
  const std::vector<std::size_t> place = shuffled(world.size(), random);
  std::vector<std::size_t> from(place.size());
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (const Scan& scan : world.scans()) {
    from[place[scan.index]] = scan.index;
    changed.now.push_back(unmoved(place[scan.index], scan.size()));
  }
  for (const std::size_t i : from) changed.scans.add_scan(world.scans()[i]);
  return changed;
}

ChangedWorld repeat_scan(const HeldScans& world, std::mt19937& random) {
  const std::size_t repeated = index_below(world.size(), random);
  ChangedWorld changed{HeldScans(world.sensor()), {}};
  for (const Scan& scan : world.scans()) {
    keep(scan, changed);
    if (scan.index == repeated) changed.scans.add_scan(scan);
  }
  return changed;
}

}  // namespace

const std::vector<Change>& changes() {
  static const std::vector<Change> all = {
      {"an empty scan at the end", add_empty_last},
      {"an empty scan between", add_empty_between},
      {"a scan in two halves", split},
      {"points of scans in another order", shuffle_points},
      {"points doubled", double_points},
      {"the world moved", move},
      {"the last scans left out", drop_last},
      {"scans in another order", shuffle_scans},
      {"a scan given twice", repeat_scan},
  };
  return all;
}

HeldScans with_other_labels(const HeldScans& world, bool other_times) {
  HeldScans other(world.sensor());
  for (Scan scan : world.scans()) {
    if (other_times) scan.time_s = 1000.0 - 7.0 * scan.time_s;
    scan.name = "other " + scan.name;
    scan.reflectance.assign(scan.size(), static_cast<float>(scan.index));
    scan.stored_index.resize(scan.size());
    std::iota(scan.stored_index.rbegin(), scan.stored_index.rend(), 0U);
    other.add_scan(std::move(scan));
  }
  return other;
}

}  // namespace raymoval::toy
