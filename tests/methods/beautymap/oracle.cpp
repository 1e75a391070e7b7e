// SPDX-License-Identifier: MIT
#include "tests/methods/beautymap/oracle.h"

namespace raymoval::beautymap_test {

void Oracle::judge(const Scan& scan) {
  if (scan.points.empty()) return;
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  center_ = static_cast<int>(p_.window_side / p_.column_size) / 2;
  if (p_.public_lattice) {
    side_ = static_cast<int>(p_.window_side / p_.column_size);
    const auto first = [&](double c) {
      return static_cast<int>((static_cast<int>(c) - center_ * p_.column_size) / p_.column_size);
    };
    first_ = {first(sensor.x() - x0_), first(sensor.y() - y0_)};
  } else {
    side_ = 2 * center_ + 1;
    const Place own = place(sensor);
    first_ = {own.first - center_, own.second - center_};
  }
  sensor_z_ = sensor.z();
  rise_ = -1e300;
  seen_.clear();
  std::map<Place, std::set<int>> all;
  for (const auto& point : scan.points) {
    const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
    const Eigen::Vector3d ray = world - sensor;
    if (ray.head<2>().norm() > 0) rise_ = std::max(rise_, ray.z() / ray.head<2>().norm());
    const Place at = place(world);
    all[{at.first - first_.first, at.second - first_.second}].insert(
        slice_of(trees_.at(at), world.z()));
  }
  rise_ *= p_.column_size / p_.slice_height;
  for (const auto& [at, slices] : all) {
    for (const int slice : slices) {
      if (slice >= 0 && slice <= 30) seen_[at].insert(slice);
    }
    const bool is_higher = *slices.rbegin() > 30, is_lower = *slices.begin() <= 30;
    if (is_higher && (is_lower || !p_.public_top)) seen_[at].insert(30);
  }
  const auto is_inside = [&](const auto& one) {
    const Place& at = one.first;
    return at.first >= 0 && at.second >= 0 && at.first < side_ && at.second < side_;
  };
  if (std::none_of(all.begin(), all.end(), is_inside)) return;
  center_foot_ = foot_at(center_, center_);
  if (!p_.public_lattice && !trees_.contains({first_.first + center_, first_.second + center_})) {
    std::vector<double> feet;
    const int reach = std::min(5, center_);
    for (int x = center_ - reach; x <= center_ + reach; ++x) {
      for (int y = center_ - reach; y <= center_ + reach; ++y) {
        const auto found = trees_.find({first_.first + x, first_.second + y});
        if (found != trees_.end()) feet.push_back(found->second.foot);
      }
    }
    std::sort(feet.begin(), feet.end());
    if (!feet.empty()) center_foot_ = feet[feet.size() / 2];
  }
  for (int x = 0; x < side_; ++x) {
    for (int y = 0; y < side_; ++y) {
      const auto found = trees_.find({first_.first + x, first_.second + y});
      if (found == trees_.end()) continue;
      Tree& tree = found->second;
      const Slices bits = tree.bits(), seen = seen_[{x, y}];
      const Slices spared = protected_by_sight(tree, seen, x - center_, y - center_);
      Slices gone;
      for (const int slice : bits) {
        if (slice == *bits.begin() || seen.contains(slice) || spared.contains(slice)) continue;
        if (!is_hidden(slice, x, y)) gone.insert(slice);
      }
      if (gone.empty()) continue;
      tree.removed.insert(gone.begin(), gone.end());
      const int ground = *gone.begin() - 1;
      const Slices parts = above_ground(tree, ground);
      tree.removed_parts[ground].insert(parts.begin(), parts.end());
    }
  }
}

Slices Oracle::protected_by_sight(const Tree& tree, const Slices& seen, int dx, int dy) const {
  int from = 31;
  const int blind = static_cast<int>(2.0 / p_.column_size) + 1;
  const int end = p_.public_lattice ? blind - 1 : blind;
  const double away = std::sqrt(dx * dx + dy * dy);
  Slices high = seen;
  high.erase(0);
  if (dx >= -blind && dx <= end && dy >= -blind && dy <= end) {
    from = 0;
  } else if (!seen.contains(0) &&
             dx * dx + dy * dy >= std::pow(p_.sight_range / p_.column_size, 2)) {
    from = 0;
  } else if (!high.empty() && !tree.is_outlier) {
    from = *high.rbegin();
  } else {
    const double eye = (sensor_z_ - center_foot_) / p_.slice_height + 0.5;
    from = static_cast<int>(std::max(0.0, std::min(31.0, eye + away * rise_ + 0.5)));
  }
  Slices all;
  for (int slice = from; slice < 31; ++slice) all.insert(slice);
  return all;
}

bool Oracle::is_hidden(int slice, int x, int y) const {
  const int dx = x - center_, dy = y - center_, length = std::max(std::abs(dx), std::abs(dy));
  if (length == 0) return false;
  for (int step = 1;; ++step) {
    if (!p_.public_rays && step >= length) return false;
    const double share = static_cast<double>(step) / length;
    // A hundredth of the difference to the nearest other fraction, against rounding.
    const double hair = 1e-6;
    const auto column = [&](int whole) {
      if (p_.public_rays) return static_cast<int>(std::floor(whole * share + hair));
      const int columns = static_cast<int>(std::floor(std::abs(whole) * share + 0.5 + hair));
      return whole < 0 ? -columns : columns;
    };
    const int at_x = center_ + column(dx), at_y = center_ + column(dy);
    if (at_x < 0 || at_y < 0 || at_x >= side_ || at_y >= side_) return false;
    const int way = static_cast<int>(std::abs(dx) * share + hair) +
                    static_cast<int>(std::abs(dy) * share + hair);
    if (way <= 3) continue;
    const double foot = foot_at(at_x, at_y), h = p_.slice_height;
    double on_ray = 0;
    if (p_.public_rays) {
      const double eye = (sensor_z_ - center_foot_) / h + 0.5;
      on_ray = std::trunc(foot - center_foot_ + (slice - eye) * share + eye + 0.5);
    } else {
      const double target = foot_at(x, y) + (slice + 0.5) * h;
      on_ray = std::floor((sensor_z_ + (target - sensor_z_) * share - foot) / h);
    }
    const auto found = seen_.find({at_x, at_y});
    if (found != seen_.end() && found->second.contains(static_cast<int>(on_ray))) return true;
    if (step >= length - 1 && step <= length + 1) return false;
  }
}

Slices Oracle::above_ground(const Tree& tree, int slice) const {
  if (slice < 0 || !tree.kept.contains(slice)) return {};
  std::map<int, int> points;
  for (const double height : tree.heights.at(slice)) {
    ++points[std::max(part_of(height, slice), 0)];
  }
  Slices above;
  int below = 0, last = -1;
  for (const auto& [part, count] : points) {
    if (last >= 0 && part - last > 2) break;
    last = part;
    if (below >= 0.85 * static_cast<double>(tree.heights.at(slice).size())) {
      above.insert(part);
    }
    below += count;
  }
  return above;
}

bool Oracle::is_removed(const Tree& tree, double z) const {
  const int slice = slice_of(tree, z);
  if (slice < 0 || !tree.kept.contains(slice)) return false;
  if (tree.removed.contains(std::min(slice, 30))) {
    return slice < 30 || !p_.public_top || slice == *tree.kept.rbegin();
  }
  const auto parts = tree.removed_parts.find(slice);
  return slice < 30 && parts != tree.removed_parts.end() &&
         parts->second.contains(part_of(z - tree.foot, slice));
}

}  // namespace raymoval::beautymap_test
