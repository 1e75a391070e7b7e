// SPDX-License-Identifier: MIT
// BeautyMap written straight from its description with lists of points: slow and plain.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/beautymap/beautymap.h"

namespace raymoval::beautymap_test {

using namespace beautymap_method;

using Place = std::pair<int, int>;
using Slices = std::set<int>;

/// What the description calls a tree: slices of points, and each slice's parts.
struct Tree {
  double foot = 0.0;
  bool is_outlier = false;
  std::map<int, std::vector<double>> heights;  ///< Above the foot; by slice, without the top rule.
  Slices kept;                                 ///< Those below the first gap of two slices.
  Slices removed;
  std::map<int, Slices> removed_parts;

  [[nodiscard]] Slices bits() const {
    Slices bits;
    for (const int slice : kept) bits.insert(std::min(slice, 30));
    return bits;
  }
};

class Oracle {
 public:
  Oracle(const Parameters& parameters, const ScanSource& scans) : p_(parameters) {
    for (std::size_t i = 0; i < scans.size(); ++i) scans_.push_back(scans.load(i));
    part_ = std::max(0.1, p_.slice_height / 31);
    place_columns();
    place_feet();
    fill();
    for (const Scan& scan : scans_) judge(scan);
  }

  [[nodiscard]] Mask mask(std::size_t i) const {
    Mask mask;
    for (const auto& point : scans_[i].points) {
      const Eigen::Vector3d world = scans_[i].T_world_sensor * point.cast<double>();
      mask.push_back(is_removed(trees_.at(place(world)), world.z()) ? 1 : 0);
    }
    return mask;
  }

 private:
  [[nodiscard]] Place place(const Eigen::Vector3d& world) const {
    return {static_cast<int>(std::floor((world.x() - x0_) / p_.column_size)),
            static_cast<int>(std::floor((world.y() - y0_) / p_.column_size))};
  }
  [[nodiscard]] int slice_of(const Tree& tree, double z) const {
    const double slice = (z - tree.foot) / p_.slice_height;
    return slice <= -1 ? -1 : static_cast<int>(slice);
  }
  [[nodiscard]] int parts() const {
    return static_cast<int>(std::ceil(p_.slice_height / part_ - 1e-9));
  }
  [[nodiscard]] int part_of(double height, int slice) const {
    const double part = (height - slice * p_.slice_height) / part_;
    return part <= -1 ? -1 : std::min(static_cast<int>(part), parts() - 1);
  }

  void place_columns() {
    if (p_.public_lattice) x0_ = y0_ = 1e300;
    for (const Scan& scan : scans_) {
      for (const auto& point : scan.points) {
        const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
        if (!p_.public_lattice) continue;
        x0_ = std::min(x0_, world.x());
        y0_ = std::min(y0_, world.y());
      }
    }
    for (const Scan& scan : scans_) {
      for (const auto& point : scan.points) {
        const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
        lowest_ = std::min(lowest_, world.z());
        const auto [tree, is_new] = trees_.try_emplace(place(world));
        tree->second.foot = is_new ? world.z() : std::min(tree->second.foot, world.z());
      }
    }
  }

  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  }

  void place_feet() {
    const std::map<Place, Tree> before = trees_;
    const int n = 5;
    for (auto& [place, tree] : trees_) {
      std::vector<double> around;
      for (const auto& [other, its] : p_.public_outliers ? trees_ : before) {
        const int dx = other.first - place.first, dy = other.second - place.second;
        const bool is_near = p_.public_outliers
                                 ? dx >= -n && dx < 0 && dy >= -n && dy < 0
                                 : std::abs(dx) <= n && std::abs(dy) <= n && (dx != 0 || dy != 0);
        if (is_near) around.push_back(its.foot);
      }
      const double all = p_.public_outliers ? n * n : (2 * n + 1) * (2 * n + 1) - 1;
      if (around.empty() || static_cast<double>(around.size()) < 0.6 * all) continue;
      const double middle = median(around);
      std::vector<double> deviations;
      for (const double z : around) deviations.push_back(std::abs(z - middle));
      const double reach = 3.0 * median(deviations);
      const double measured = tree.foot;
      tree.foot = std::min(std::max(tree.foot, middle - reach), middle + reach);
      tree.is_outlier = tree.foot != measured;
    }
  }

  void fill() {
    for (const Scan& scan : scans_) {
      for (const auto& point : scan.points) {
        const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
        Tree& tree = trees_.at(place(world));
        const int slice = slice_of(tree, world.z());
        if (slice >= 0) tree.heights[slice].push_back(world.z() - tree.foot);
      }
    }
    for (auto& [place, tree] : trees_) {
      for (const auto& [slice, heights] : tree.heights) {
        if (!tree.kept.empty() && slice - *tree.kept.rbegin() > 2) break;
        tree.kept.insert(slice);
      }
    }
  }

  void judge(const Scan& scan);
  [[nodiscard]] Slices protected_by_sight(const Tree& tree, const Slices& seen, int dx,
                                          int dy) const;
  [[nodiscard]] bool is_hidden(int slice, int x, int y) const;
  [[nodiscard]] Slices above_ground(const Tree& tree, int slice) const;
  [[nodiscard]] bool is_removed(const Tree& tree, double z) const;
  [[nodiscard]] double foot_at(int x, int y) const {
    const auto found = trees_.find({first_.first + x, first_.second + y});
    return found == trees_.end() ? lowest_ : found->second.foot;
  }

  Parameters p_;
  std::vector<Scan> scans_;
  double part_ = 0.0, x0_ = 0.0, y0_ = 0.0, lowest_ = 1e300;
  std::map<Place, Tree> trees_;
  // Of the scan that is being judged.
  Place first_;
  int side_ = 0, center_ = 0;
  double sensor_z_ = 0.0, center_foot_ = 0.0, rise_ = 0.0;
  std::map<Place, Slices> seen_;  ///< By place in the window.
};

}  // namespace raymoval::beautymap_test
