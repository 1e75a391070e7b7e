// SPDX-License-Identifier: MIT
#include "tests/methods/hmm_mos/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raymoval::hmm_mos_test {
namespace {

/// The cells at most `reach` away along each axis, and the cell itself.
std::vector<Cell> cube(const Cell& cell, int reach) {
  std::vector<Cell> cells;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        cells.push_back({cell[0] + x, cell[1] + y, cell[2] + z});
      }
    }
  }
  return cells;
}

Cell floor_of(const Eigen::Vector3d& v) {
  return {static_cast<int>(std::floor(v.x())), static_cast<int>(std::floor(v.y())),
          static_cast<int>(std::floor(v.z()))};
}

}  // namespace

Cell Oracle::cell_of(const Eigen::Vector3d& world) const {
  const Eigen::Vector3d v = world / p_.voxel_size;
  if (!p_.public_lattice) return floor_of(v);
  return {static_cast<int>(v.x()), static_cast<int>(v.y()), static_cast<int>(v.z())};
}

Eigen::Vector3d Oracle::position(const Cell& cell) const {
  const double shift = p_.public_lattice ? 0.0 : 0.5;
  return Eigen::Vector3d(cell[0] + shift, cell[1] + shift, cell[2] + shift) * p_.voxel_size;
}

std::vector<Cell> Oracle::line(const Cell& from, const Cell& to) {
  std::array<int, 3> difference{}, step{}, error{};
  int length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    difference[k] = std::abs(to[k] - from[k]);
    step[k] = to[k] > from[k] ? 1 : -1;
    length = std::max(length, difference[k]);
  }
  error.fill(length / 2);
  std::vector<Cell> cells;
  Cell cell = from;
  for (int i = 0; i <= length; ++i) {
    cells.push_back(cell);
    for (std::size_t k = 0; k < 3; ++k) {
      error[k] -= difference[k];
      if (error[k] >= 0) continue;
      error[k] += length;
      cell[k] += step[k];
    }
  }
  return cells;
}

void Oracle::add(const Scan& scan) {
  ++now_;
  find_cells(scan);
  std::map<Cell, double> distances;
  for (const Cell& cell : observed) distances[cell] = squared_distance(cell);
  for (const auto& [cell, distance] : distances) observe(cell, distance);
  forget(scan.T_world_sensor.translation());
  std::map<Cell, int> raw;
  for (const Cell& cell : occupied) raw[cell] = now_ > p_.window_scans ? score(cell) : 0;
  scores.clear();
  for (const Cell& cell : occupied) scores[cell] = median(cell, raw);
  history_.push_back(scores);
  if (history_.size() > static_cast<std::size_t>(p_.window_scans)) history_.pop_front();
  sums.clear();
  for (const Cell& cell : occupied) {
    for (const auto& of_scan : history_) {
      if (of_scan.contains(cell)) sums[cell] += of_scan.at(cell);
    }
  }
  find_threshold();
  find_dynamic();
  before_ = ends_;
}

void Oracle::find_cells(const Scan& scan) {
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  const auto is_near = [&](const Cell& cell) {
    return (position(cell) - sensor).norm() <= p_.max_range;
  };
  occupied.clear();
  observed.clear();
  for (const auto& point : scan.points) {
    if (!(point.cast<double>().norm() > p_.min_range)) continue;
    occupied.insert(cell_of(scan.T_world_sensor * point.cast<double>()));
  }
  for (const Cell& end : occupied) {
    for (const Cell& cell : line(floor_of(sensor / p_.voxel_size), end)) {
      if (is_near(cell)) observed.insert(cell);
    }
  }
  ends_ = occupied;
  std::erase_if(occupied, [&](const Cell& cell) { return !is_near(cell); });
}

double Oracle::squared_distance(const Cell& cell) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Cells* cells : {&ends_, &before_}) {
    for (const Cell& other : *cells) {
      double squared = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        squared += (other[k] - cell[k]) * (other[k] - cell[k]);
      }
      nearest = std::min(nearest, squared);
    }
  }
  return nearest * p_.voxel_size * p_.voxel_size;
}

void Oracle::observe(const Cell& cell, double squared_distance) {
  const double e = p_.transition, sigma = p_.spread * p_.voxel_size;
  Eigen::Matrix3d A;
  A << 1.0 - 2.0 * e, 0.0, 0.0, e, 1.0 - e, e, e, e, 1.0 - e;
  const double po = std::exp(-squared_distance / (2.0 * sigma * sigma));
  Believed& voxel = map[cell];
  const Eigen::Vector3d x = Eigen::Vector3d(0.0, po, 1.0 - po).cwiseProduct(A * voxel.belief);
  voxel.belief = x / x.sum();
  Eigen::Index most = 0;
  if (voxel.belief.maxCoeff(&most) > p_.belief) {
    const State state = static_cast<State>(most);
    if (state != voxel.state && voxel.state != State::kUnobserved) voxel.change = now_;
    voxel.state = last_known[cell] = state;
  }
  voxel.seen = now_;
}

void Oracle::forget(const Eigen::Vector3d& sensor) {
  std::erase_if(map, [&](const auto& entry) {
    const bool is_far =
        (position(entry.first) - sensor).norm() > p_.max_range * p_.map_range_factor;
    return is_far || now_ - entry.second.seen > p_.map_scans;
  });
}

int Oracle::score(const Cell& cell) const {
  int score = 0;
  for (const Cell& other : cube(cell, p_.reach)) {
    const auto found = map.find(other);
    if (found == map.end() || found->second.state == State::kUnobserved) {
      --score;
    } else if (found->second.change == now_ && occupied.contains(other)) {
      ++score;
    }
  }
  return std::max(score, 0);
}

int Oracle::median(const Cell& cell, const std::map<Cell, int>& raw) const {
  std::vector<int> around;
  for (const Cell& other : cube(cell, 1)) {
    if (raw.contains(other)) around.push_back(raw.at(other));
  }
  std::sort(around.begin(), around.end());
  const std::size_t n = around.size();
  return n % 2 == 1 ? around[n / 2] : (around[n / 2 - 1] + around[n / 2]) / 2;
}

void Oracle::find_threshold() {
  has_threshold = false;
  if (sums.empty()) return;
  std::vector<int> values;
  for (const auto& [cell, sum] : sums) values.push_back(sum);
  const int low = *std::min_element(values.begin(), values.end());
  const int high = *std::max_element(values.begin(), values.end());
  if (low == high) return;
  constexpr int kBins = 100;
  // Every edge between two bins, with the values up to it and above it.
  double best = 0.0;
  for (int i = 1; i < kBins; ++i) {
    const auto bin_of = [&](int value) {
      int bin = 0;
      while (bin + 1 < kBins && value * kBins > low * kBins + (bin + 1) * (high - low)) ++bin;
      return bin;
    };
    double below = 0.0, above = 0.0, below_sum = 0.0, above_sum = 0.0;
    for (const int value : values) {
      const int bin = bin_of(value);
      (bin < i ? below : above) += 1.0;
      (bin < i ? below_sum : above_sum) += bin;
    }
    if (below == 0.0 || above == 0.0) continue;
    const double between = below * above * std::pow(below_sum / below - above_sum / above, 2.0);
    if (between < best) continue;
    best = between;
    has_threshold = true;
    threshold = low + i * static_cast<double>(high - low) / kBins;
  }
}

void Oracle::find_dynamic() {
  Cells seeds;
  for (const auto& [cell, sum] : sums) {
    if (has_threshold && sum > threshold) seeds.insert(cell);
    if (dynamic.contains(cell) && sum > p_.least_threshold) seeds.insert(cell);
  }
  dynamic.clear();
  for (const Cell& cell : seeds) {
    for (const Cell& other : cube(cell, 1)) {
      if (occupied.contains(other)) dynamic.insert(other);
    }
  }
}

Mask Oracle::mask(const Scan& scan) const {
  Mask mask;
  for (const auto& point : scan.points) {
    const bool counts = point.cast<double>().norm() > p_.min_range;
    const bool moves = has_threshold && threshold > p_.least_threshold && counts &&
                       dynamic.contains(cell_of(scan.T_world_sensor * point.cast<double>()));
    mask.push_back(moves ? 1 : 0);
  }
  return mask;
}

Mask Oracle::last_free(const Scan& scan) const {
  Mask mask;
  for (const auto& point : scan.points) {
    bool is_free = false;
    if (point.cast<double>().norm() > p_.min_range) {
      const auto found = last_known.find(cell_of(scan.T_world_sensor * point.cast<double>()));
      is_free = found != last_known.end() && found->second == State::kFree;
    }
    mask.push_back(is_free ? 1 : 0);
  }
  return mask;
}

}  // namespace raymoval::hmm_mos_test
