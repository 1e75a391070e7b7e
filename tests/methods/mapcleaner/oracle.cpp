// SPDX-License-Identifier: MIT
#include "tests/methods/mapcleaner/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace raymoval::mapcleaner_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double& Oracle::put(Cells& cells, int x, int y) {
  if (x < -kHalf || x >= kHalf || y < -kHalf || y >= kHalf) throw std::out_of_range("oracle");
  return cells[static_cast<std::size_t>((y + kHalf) * 2 * kHalf + x + kHalf)];
}

double Oracle::at(const Cells& cells, int x, int y) {
  if (x < -kHalf || x >= kHalf || y < -kHalf || y >= kHalf) return kNone;
  return cells[static_cast<std::size_t>((y + kHalf) * 2 * kHalf + x + kHalf)];
}

int Oracle::cell(double c) const {
  return static_cast<int>(std::floor(c / p_.terrain_cell));
}

Oracle::Voxel Oracle::voxel(const Eigen::Vector3d& world) const {
  Voxel voxel;
  for (int k = 0; k < 3; ++k)
    voxel.push_back(static_cast<int>(std::floor(world[k] / p_.voxel_size)));
  return voxel;
}

Oracle::Oracle(const Parameters& parameters, const ScanSource& scans)
    : p_(parameters), sensor_(scans.sensor()) {
  if (!p_.public_steps) {
    // The HDL-64E: 26.9 degrees by 63 steps, and 0.1728 degrees.
    const double up = std::max(1.0, sensor_.elevation_step * 180 / M_PI / (26.9 / 63));
    const double around = std::max(1.0, sensor_.azimuth_step * 180 / M_PI / 0.1728);
    // A window of 2 n + 1 pixels is no smaller than a step.
    p_.row_height = std::max(
        p_.row_height, sensor_.elevation_step * 180 / M_PI / (1 + p_.window_rows + p_.window_rows));
    p_.column_width = std::max(p_.column_width, sensor_.azimuth_step * 180 / M_PI /
                                                    (1 + p_.window_columns + p_.window_columns));
    for (int* points : {&p_.bin_points, &p_.lowest_points}) {
      if (*points > 3) *points = std::max(3, static_cast<int>(std::round(*points / up / around)));
    }
  }
  GroundOracle ground(p_);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans_.push_back(scans.load(i));
    grounds_.push_back(ground.ground(scans_.back()));
  }
  measure();
  terrain_ = filled(terrain_, p_.fill_radius, p_.fill_deviation);
  terrain_ = reached(terrain_);
  terrain_ = smoothed(filled(terrain_, p_.refill_radius, p_.refill_deviation));
  vote();
}

void Oracle::measure() {
  std::map<std::pair<int, int>, std::vector<double>> heights;
  for (std::size_t s = 0; s < scans_.size(); ++s) {
    for (std::size_t i = 0; i < scans_[s].size(); ++i) {
      const Eigen::Vector3d point = world(s, i);
      if (grounds_[s][i] != 0) heights[{cell(point.x()), cell(point.y())}].push_back(point.z());
    }
  }
  terrain_.assign(4UL * kHalf * kHalf, kNone);
  for (const auto& [place, zs] : heights) {
    const auto count = static_cast<double>(zs.size());
    double mean = 0, variance = 0;
    for (const double z : zs) mean += z / count;
    for (const double z : zs) variance += (z - mean) * (z - mean) / count;
    if (count < p_.terrain_points || !(variance < p_.terrain_variance)) continue;
    put(terrain_, place.first, place.second) = mean;
  }
}

Oracle::Cells Oracle::filled(const Cells& cells, double radius, double deviation) const {
  if (radius == 0) return cells;
  const int reach = static_cast<int>(radius / p_.terrain_cell) + 1;
  std::map<std::pair<int, int>, double> kernel;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const double d = std::sqrt(x * x + y * y) * p_.terrain_cell / radius;
      if (d > 1 - 1e-9) continue;
      kernel[{x, y}] =
          (2 + std::cos(2 * M_PI * d)) / 3 * (1 - d) + std::sin(2 * M_PI * d) / (2 * M_PI);
    }
  }
  Cells smooth = cells, result = cells;
  for (int y = -kHalf; y < kHalf; ++y) {
    for (int x = -kHalf; x < kHalf; ++x) {
      double sum = 0, weights = 0;
      int count = 0;
      for (const auto& [step, k] : kernel) {
        const double z = at(cells, x + step.first, y + step.second);
        if (std::isnan(z)) continue;
        ++count;
        sum += k * z;
        weights += k;
      }
      put(smooth, x, y) = count >= p_.fill_cells ? sum / weights : kNone;
    }
  }
  for (int y = -kHalf; y < kHalf; ++y) {
    for (int x = -kHalf; x < kHalf; ++x) {
      if (!std::isnan(at(cells, x, y)) || std::isnan(at(smooth, x, y))) continue;
      double sum = 0, weights = 0;
      for (const auto& [step, k] : kernel) {
        const double z = at(cells, x + step.first, y + step.second);
        const double z1 = at(smooth, x + step.first, y + step.second);
        if (std::isnan(z) || std::isnan(z1)) continue;
        const double c = std::exp(-std::min(60.0, std::pow((z - z1) / deviation, 2) / 2));
        sum += c * k * z;
        weights += c * k;
      }
      if (weights > 0) put(result, x, y) = sum / weights;
    }
  }
  return result;
}

std::pair<double, double> Oracle::gradient(const Cells& cells, int x, int y) const {
  const double here = at(cells, x, y);
  const auto slope = [&](double before, double after) {
    if (!std::isnan(before) && !std::isnan(after)) return (after - before) / 2 / p_.terrain_cell;
    if (!std::isnan(after)) return (after - here) / p_.terrain_cell;
    return std::isnan(before) ? 0 : (here - before) / p_.terrain_cell;
  };
  return {slope(at(cells, x - 1, y), at(cells, x + 1, y)),
          slope(at(cells, x, y - 1), at(cells, x, y + 1))};
}

bool Oracle::is_passable(const Cells& cells, int x, int y,
                         const std::pair<double, double>& lean) const {
  if (std::isnan(at(cells, x, y))) return false;
  const auto [along_x, along_y] = gradient(cells, x, y);
  const double u = along_x - lean.first, v = along_y - lean.second;
  return std::acos(1 / std::sqrt(1 + u * u + v * v)) < p_.terrain_slope * M_PI / 180;
}

std::pair<double, double> Oracle::lean(const Cells& cells, int x, int y, double radius) const {
  std::vector<double> us, vs;
  for (int i = 0; i < 2 * kHalf; ++i) {
    for (int k = 0; k < 2 * kHalf; ++k) {
      const int cx = i - kHalf, cy = k - kHalf;
      if (std::hypot(cx - x, cy - y) > radius || std::isnan(at(cells, cx, cy))) continue;
      us.push_back(gradient(cells, cx, cy).first);
      vs.push_back(gradient(cells, cx, cy).second);
    }
  }
  const auto middle = [](std::vector<double>& all) {
    std::sort(all.begin(), all.end());
    return all.empty() ? 0.0 : (all[(all.size() - 1) / 2] + all[all.size() / 2]) / 2;
  };
  return {middle(us), middle(vs)};
}

void Oracle::reach(const Cells& cells, int x, int y, const std::pair<double, double>& lean,
                   Cells& kept) const {
  std::vector<std::pair<int, int>> next = {{x, y}};
  while (!next.empty()) {
    const auto [cx, cy] = next.back();
    next.pop_back();
    if (!is_passable(cells, cx, cy, lean) || !std::isnan(at(kept, cx, cy))) continue;
    put(kept, cx, cy) = at(cells, cx, cy);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) next.emplace_back(cx + dx, cy + dy);
    }
  }
}

Oracle::Cells Oracle::reached(const Cells& cells) const {
  Cells kept(cells.size(), kNone);
  for (const Scan& scan : scans_) {
    if (scan.points.empty()) continue;
    const int x = cell(scan.T_world_sensor.translation().x());
    const int y = cell(scan.T_world_sensor.translation().y());
    const double radius = p_.start_radius / p_.terrain_cell;
    const auto nearest = [&](const std::pair<double, double>& lean) {
      std::map<int, std::vector<std::pair<int, int>>> by_distance;
      for (int dy = -kHalf; dy <= kHalf; ++dy) {
        for (int dx = -kHalf; dx <= kHalf; ++dx) {
          const int square = dx * dx + dy * dy;
          if (square > radius * radius || !is_passable(cells, x + dx, y + dy, lean)) continue;
          by_distance[square].emplace_back(x + dx, y + dy);
        }
      }
      return by_distance.empty() ? std::vector<std::pair<int, int>>() : by_distance.begin()->second;
    };
    std::pair<double, double> from(0.0, 0.0);
    if (!is_passable(cells, x, y, from) && radius > 0) {
      const auto [u, v] = lean(cells, x, y, radius);
      if (std::atan(std::hypot(u, v)) >= p_.terrain_slope * M_PI / 180) from = {u, v};
    }
    for (const auto& [sx, sy] : nearest(from)) reach(cells, sx, sy, from, kept);
  }
  return kept;
}

Oracle::Cells Oracle::smoothed(const Cells& cells) {
  Cells result = cells;
  for (int y = -kHalf; y < kHalf; ++y) {
    for (int x = -kHalf; x < kHalf; ++x) {
      if (std::isnan(at(cells, x, y))) continue;
      std::vector<double> around;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (!std::isnan(at(cells, x + dx, y + dy))) around.push_back(at(cells, x + dx, y + dy));
        }
      }
      std::sort(around.begin(), around.end());
      put(result, x, y) = around[around.size() / 2];
    }
  }
  return result;
}

char Oracle::part(std::size_t scan, std::size_t point) const {
  const Eigen::Vector3d place = world(scan, point);
  const double terrain = at(terrain_, cell(place.x()), cell(place.y()));
  if (std::isnan(terrain)) return 'o';
  if (std::abs(place.z() - terrain) <= p_.ground_height) return 'g';
  return place.z() < terrain ? 'b' : 'c';
}

std::pair<int, int> Oracle::pixel(const Eigen::Vector3d& point) const {
  const double elevation = std::atan2(point.z(), point.head<2>().norm());
  double turned = std::atan2(point.y(), point.x()) - left_;
  while (turned < 0) turned += 2 * M_PI;
  while (turned >= 2 * M_PI) turned -= 2 * M_PI;
  const int row = static_cast<int>(std::floor((elevation - low_) / row_height_));
  int column = static_cast<int>(std::floor(turned / column_width_));
  if (is_circle_) column = std::min(column, columns_ - 1);
  const bool is_inside = row >= 0 && row < rows_ && column < columns_ && point.norm() > 0;
  return is_inside ? std::pair(row, column) : std::pair(-1, -1);
}

int Oracle::look(const std::map<std::pair<int, int>, double>& image,
                 const Eigen::Vector3d& point) const {
  const auto [row, column] = pixel(point);
  if (row < 0) return 0;
  bool is_seen = false, is_hidden = false, is_through = false;
  for (int dy = -p_.window_rows; dy <= p_.window_rows; ++dy) {
    for (int dx = -p_.window_columns; dx <= p_.window_columns; ++dx) {
      const int x = is_circle_ ? (column + dx + columns_) % columns_ : column + dx;
      const auto found = image.find({row + dy, x});
      if (found == image.end()) continue;
      const double difference = point.norm() - found->second;
      if (std::abs(difference) <= p_.tolerance) is_seen = true;
      if (difference > p_.tolerance) is_hidden = true;
      if (difference < -p_.tolerance) is_through = true;
    }
  }
  if (is_seen) return -1;
  return is_hidden ? 0 : is_through ? 1 : 0;
}

void Oracle::vote() {
  const double degree = M_PI / 180;
  row_height_ = p_.row_height * degree;
  column_width_ = p_.column_width * degree;
  double high = p_.vertical_view / 2 * degree, right = M_PI;
  low_ = -high;
  left_ = -M_PI;
  if (!p_.public_field_of_view) {
    is_circle_ = sensor_.azimuth_max - sensor_.azimuth_min > 6.2;
    // Where a window is as high as a step, beams lie in the middle of rows.
    const double window = row_height_ * (1 + 2 * p_.window_rows);
    const bool is_sparse = !p_.public_steps && std::abs(sensor_.elevation_step - window) < 1e-9;
    low_ = sensor_.elevation_min - row_height_ - (is_sparse ? row_height_ / 2 : 0);
    high = sensor_.elevation_max + row_height_ + (is_sparse ? row_height_ / 2 : 0);
    if (!is_circle_) left_ = sensor_.azimuth_min - column_width_;
    if (!is_circle_) right = sensor_.azimuth_max + column_width_;
  }
  rows_ = static_cast<int>(std::ceil((high - low_) / row_height_ - 1e-6));
  columns_ = static_cast<int>(std::ceil((right - left_) / column_width_ - 1e-6));
  std::map<Voxel, std::pair<Eigen::Vector3d, int>> sums;
  for (std::size_t s = 0; s < scans_.size(); ++s) {
    for (std::size_t i = 0; i < scans_[s].size(); ++i) {
      if (part(s, i) != 'c') continue;
      const auto zero = std::pair<Eigen::Vector3d, int>(Eigen::Vector3d::Zero(), 0);
      auto& sum = sums.try_emplace(voxel(world(s, i)), zero).first->second;
      sum.first += world(s, i);
      ++sum.second;
    }
  }
  bool has_origin = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (const Scan& scan : scans_) {
    if (scan.points.empty()) continue;
    const Eigen::Vector3d place = scan.T_world_sensor.translation();
    if (!has_origin || (place - origin).norm() > p_.submap_travel) origin = place;
    has_origin = true;
    std::map<std::pair<int, int>, double> image;
    for (const Eigen::Vector3f& single : scan.points) {
      const Eigen::Vector3d point = single.cast<double>();
      const auto at = pixel(point);
      if (at.first < 0) continue;
      const bool is_new = image.try_emplace(at, point.norm()).second;
      if (!is_new)
        image[at] = p_.public_overwrite ? point.norm() : std::min(image[at], point.norm());
    }
    for (const auto& [key, sum] : sums) {
      const Eigen::Vector3d centroid = sum.first / sum.second;
      if ((centroid - origin).norm() > p_.submap_radius) continue;
      votes_[key] += look(image, scan.T_world_sensor.inverse() * centroid);
    }
  }
}

Mask Oracle::mask(std::size_t i) const {
  Mask mask;
  for (std::size_t k = 0; k < scans_[i].size(); ++k) {
    const char own = part(i, k);
    bool removed =
        own == 'c' && votes_.contains(voxel(world(i, k))) && votes_.at(voxel(world(i, k))) > 0;
    if (own == 'b') removed = p_.remove_below;
    mask.push_back(removed ? 1 : 0);
  }
  return mask;
}

}  // namespace raymoval::mapcleaner_test
