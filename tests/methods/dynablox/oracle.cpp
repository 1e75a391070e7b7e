// SPDX-License-Identifier: MIT
#include "tests/methods/dynablox/oracle.h"

#include <algorithm>
#include <cmath>

#include "methods/dynablox/voxel_kernels.h"

namespace raymoval::dynablox_test {
namespace {

constexpr int kBlockSide = 16;

int floor_of(double value) {
  return static_cast<int>(std::floor(value));
}

Cell block_with(const Cell& cell) {
  Cell block;
  for (std::size_t k = 0; k < 3; ++k) block[k] = floor_of(cell[k] / double{kBlockSide});
  return block;
}

/// The cells around a cell that differ from it along at most `axes` axes: 6, 18 or 26 cells.
std::vector<Cell> around(const Cell& cell, int axes) {
  std::vector<Cell> cells;
  for (int i = 0; i < 27; ++i) {
    const int dx = i % 3 - 1, dy = i / 3 % 3 - 1, dz = i / 9 - 1;
    const int differing = dx * dx + dy * dy + dz * dz;
    if (differing > 0 && differing <= axes) {
      cells.push_back({cell[0] + dz, cell[1] + dy, cell[2] + dx});
    }
  }
  return cells;
}

}  // namespace

float arc_tangent(float y, float x) {
  const float across = std::abs(x), up = std::abs(y);
  const float most = std::max(across, up);
  const float a = std::min(across, up) / std::max(most, 1e-30F);
  const float square = a * a;
  float sum = 0.0F;
  for (const float term : kernels::kArcTangentTerms) sum = sum * square + term;
  float angle = sum * a;
  if (up > across) angle = 0.5F * kernels::kHalfTurn - angle;
  if (x < 0.0F) angle = kernels::kHalfTurn - angle;
  return std::copysign(angle, y);
}

Oracle::Oracle(const Parameters& parameters, const SensorModel& sensor)
    : parameters_(parameters),
      grid_(sensor),
      max_range_(std::min(parameters.max_range, sensor.range_max)) {}

Cell Oracle::cell_of(const Scan& scan, std::size_t point) const {
  const Eigen::Vector3d world = scan.T_world_sensor * scan.points[point].cast<double>();
  const double inverse = 1.0 / parameters_.voxel_size;
  return {floor_of(world.z() * inverse), floor_of(world.y() * inverse),
          floor_of(world.x() * inverse)};
}

const Voxel* Oracle::find(const Cell& cell) const {
  const auto block = blocks_.find(block_with(cell));
  return block == blocks_.end() ? nullptr : &block->second.at(cell);
}

Voxel* Oracle::find(const Cell& cell) {
  return const_cast<Voxel*>(static_cast<const Oracle*>(this)->find(cell));
}

int Oracle::ever_free_count() const {
  int count = 0;
  for (const auto& [at, block] : blocks_) {
    for (const auto& [cell, voxel] : block) count += voxel.ever_free ? 1 : 0;
  }
  return count;
}

std::vector<Mask> Oracle::masks(const ScanSource& scans) {
  std::vector<Mask> masks;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    masks.push_back(judge(scan));
    update_free_space(scan);
    integrate(scan);
  }
  for (std::size_t i = 0; parameters_.offline && i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const Voxel* voxel = find(cell_of(scan, k));
      masks[i][k] = voxel != nullptr && voxel->ever_free ? 1 : 0;
    }
  }
  return masks;
}

Mask Oracle::judge(const Scan& scan) const {
  std::map<Cell, std::vector<std::size_t>> points;
  std::set<Cell> hit;
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Cell cell = cell_of(scan, k);
    points[cell].push_back(k);
    hit.insert(cell);
  }
  std::vector<Cluster> clusters = grow(hit);
  merge(clusters);
  Mask mask(scan.size(), 0);
  for (const Cluster& cluster : clusters) {
    std::vector<std::size_t> its;
    for (const Cell& cell : cluster) {
      its.insert(its.end(), points[cell].begin(), points[cell].end());
    }
    if (its.size() < static_cast<std::size_t>(parameters_.min_points)) continue;
    for (const std::size_t k : its) mask[k] = 1;
  }
  return mask;
}

std::vector<Oracle::Cluster> Oracle::grow(const std::set<Cell>& hit) const {
  std::map<Cell, int> number;
  std::vector<std::pair<Cell, Cell>> joins;
  for (const Cell& cell : hit) {
    const Voxel* voxel = find(cell);
    if (voxel == nullptr || !voxel->ever_free) continue;
    number[cell] = 0;
    for (const Cell& next : around(cell, 1)) {
      if (hit.count(next) == 0) continue;
      number[next] = 0;
      joins.emplace_back(cell, next);
    }
  }
  // Numbers spread until nothing changes.
  int next = 0;
  for (auto& [cell, its] : number) its = next++;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : joins) {
      const int least = std::min(number[a], number[b]);
      changed = changed || number[a] != least || number[b] != least;
      number[a] = number[b] = least;
    }
  }
  std::map<int, Cluster> clusters;
  for (const auto& [cell, its] : number) clusters[its].insert(cell);
  std::vector<Cluster> listed;
  for (auto& [its, cluster] : clusters) listed.push_back(cluster);
  return listed;
}

bool Oracle::are_near(const Cluster& a, const Cluster& b) const {
  const double most = parameters_.separation * (1.0 + 1e-9);
  for (const Cell& p : a) {
    for (const Cell& q : b) {
      double square = 0.0;
      for (std::size_t k = 0; k < 3; ++k) square += double(p[k] - q[k]) * (p[k] - q[k]);
      if (std::sqrt(square) * parameters_.voxel_size <= most) return true;
    }
  }
  return false;
}

void Oracle::merge(std::vector<Cluster>& clusters) const {
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    for (std::size_t j = i + 1; j < clusters.size();) {
      if (!are_near(clusters[i], clusters[j])) {
        ++j;
        continue;
      }
      clusters[i].insert(clusters[j].begin(), clusters[j].end());
      clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  }
}

void Oracle::update_free_space(const Scan& scan) {
  const int now = static_cast<int>(scan.index);
  std::set<Cell> hit;
  for (std::size_t k = 0; k < scan.size(); ++k) {
    hit.insert(cell_of(scan, k));
  }
  std::vector<Cell> reset;
  for (const Cell& at : touched_) {
    for (auto& [cell, voxel] : blocks_.at(at)) {
      const bool is_near = voxel.distance < static_cast<float>(parameters_.occupied_below);
      if (!is_near && hit.count(cell) == 0) continue;
      const bool goes_on = voxel.last_occupied >= now - parameters_.temporal_buffer;
      voxel.occupied_scans = goes_on ? voxel.occupied_scans + 1 : 1;
      voxel.last_occupied = now;
      if (voxel.ever_free && voxel.occupied_scans >= parameters_.frames_to_reset) {
        reset.push_back(cell);
      }
    }
  }
  for (const Cell& cell : reset) {
    find(cell)->ever_free = false;
    for (const Cell& other : around(cell, 3)) {
      if (Voxel* voxel = find(other)) voxel->ever_free = false;
    }
  }
  for (const Cell& at : touched_) {
    for (auto& [cell, voxel] : blocks_.at(at)) become_ever_free(cell, voxel, now);
  }
}

void Oracle::become_ever_free(const Cell& cell, Voxel& voxel, int now) {
  const auto is_settled = [&](const Voxel& any) {
    return any.weight > 1e-6F && any.last_occupied <= now - parameters_.burn_in;
  };
  if (voxel.ever_free || !is_settled(voxel)) return;
  for (const Cell& other : around(cell, 3)) {
    const Voxel* neighbour = find(other);
    if (neighbour == nullptr || !is_settled(*neighbour)) return;
  }
  voxel.ever_free = true;
}

std::vector<float> Oracle::image_of(const Scan& scan) const {
  std::vector<float> image(static_cast<std::size_t>(grid_.columns * grid_.rows), 0.0F);
  for (const Eigen::Vector3f& p : scan.points) {
    const float level = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const float range = std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
    if (range < static_cast<float>(parameters_.min_range)) continue;
    const float turned = arc_tangent(p.y(), p.x()) + kernels::kHalfTurn;
    const float raised = arc_tangent(p.z(), level) - grid_.elevation_min;
    const int row = floor_of(raised * grid_.rows_per_radian + 0.5F);
    const int column = std::min(floor_of(turned * grid_.columns_per_radian), grid_.columns - 1);
    if (row < 0 || row >= grid_.rows) continue;
    float& pixel = image[static_cast<std::size_t>(row * grid_.columns + column)];
    if (pixel == 0.0F || range < pixel) pixel = range;
  }
  return image;
}

float Oracle::pixel(const std::vector<float>& image, int column, int row) const {
  if (row < 0 || row >= grid_.rows) return 0.0F;
  const int within = (column + grid_.columns) % grid_.columns;
  return image[static_cast<std::size_t>(row * grid_.columns + within)];
}

float Oracle::adaptive_range(const std::vector<float>& image, float u, float v) const {
  const int left = floor_of(u), below = floor_of(v);
  const float share_across = u - std::floor(u), share_up = v - std::floor(v);
  float least = 0.0F;
  std::vector<float> of_column;
  for (const int across : {0, 1}) {
    const float lower = pixel(image, left + across, below);
    const float upper = pixel(image, left + across, below + 1);
    for (const float range : {lower, upper}) {
      if (range > 0.0F && (least == 0.0F || range < least)) least = range;
    }
    of_column.push_back(lower == 0.0F   ? upper
                        : upper == 0.0F ? lower
                                        : (1.0F - share_up) * lower + share_up * upper);
  }
  const float mean = of_column[0] == 0.0F ? of_column[1]
                     : of_column[1] == 0.0F
                         ? of_column[0]
                         : (1.0F - share_across) * of_column[0] + share_across * of_column[1];
  return least + 0.5F * static_cast<float>(parameters_.truncation) < mean ? least : mean;
}

float Oracle::weight_of_scan(float square, float ahead) const {
  // A voxel covers as many square radians as its area over the square of its range says.
  const double area = parameters_.voxel_size * parameters_.voxel_size;
  const auto at_a_metre = static_cast<float>(area * grid_.pixels_per_square_radian);
  const float rays = at_a_metre / std::max(square, 1.0F);
  const auto truncation = static_cast<float>(parameters_.truncation);
  const auto size = static_cast<float>(parameters_.voxel_size);
  return ahead < -size ? rays * (truncation + ahead) / (truncation - size) : rays;
}

void Oracle::update(const Scan& scan, const std::vector<float>& image, const Cell& cell,
                    Voxel& voxel) {
  const Pose T_sensor_world = scan.T_world_sensor.inverse();
  const Cell block = block_with(cell);
  const double size = parameters_.voxel_size;
  // Single precision from the first voxel of the layer on, in the method's order of additions.
  const Eigen::Vector3d first((block[2] * kBlockSide + 0.5) * size,
                              (block[1] * kBlockSide + 0.5) * size, (cell[0] + 0.5) * size);
  const Eigen::Vector3f along_x = (T_sensor_world.linear().col(0) * size).cast<float>();
  const Eigen::Vector3f along_y = (T_sensor_world.linear().col(1) * size).cast<float>();
  const Eigen::Vector3f row_first = (T_sensor_world * first).cast<float>() +
                                    static_cast<float>(cell[1] - block[1] * kBlockSide) * along_y;
  const Eigen::Vector3f p =
      row_first + static_cast<float>(cell[2] - block[2] * kBlockSide) * along_x;
  const float level_square = p.x() * p.x() + p.y() * p.y();
  const float square = level_square + p.z() * p.z();
  const float range = std::sqrt(square);
  if (range < static_cast<float>(parameters_.min_range)) return;
  if (range > static_cast<float>(max_range_)) return;
  const float v =
      (arc_tangent(p.z(), std::sqrt(level_square)) - grid_.elevation_min) * grid_.rows_per_radian;
  if (v < 0.0F || v > static_cast<float>(grid_.rows - 1)) return;
  const float u =
      (arc_tangent(p.y(), p.x()) + kernels::kHalfTurn) * grid_.columns_per_radian - 0.5F;
  const float seen = adaptive_range(image, u, v);
  const auto truncation = static_cast<float>(parameters_.truncation);
  if (seen == 0.0F || seen - range <= -truncation) return;
  const float added = weight_of_scan(square, seen - range);
  const float weight = voxel.weight + added;
  voxel.distance =
      (voxel.distance * voxel.weight + std::min(seen - range, truncation) * added) / weight;
  voxel.weight = std::min(weight, static_cast<float>(parameters_.max_weight));
}

/// Makes the blocks that the rays go through, which are found by cutting rays with boxes.
void Oracle::touch(const Scan& scan) {
  touched_.clear();
  const double edge = kBlockSide * parameters_.voxel_size;
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d ahead = scan.T_world_sensor.linear() * point.cast<double>();
    const double range = point.cast<double>().norm();
    if (range < parameters_.min_range || range > max_range_) continue;
    const double reach = range + parameters_.truncation;
    const Eigen::Vector3d end = sensor + ahead / range * reach;
    Cell low, high;
    for (Eigen::Index k = 0; k < 3; ++k) {
      low[static_cast<std::size_t>(2 - k)] = floor_of(std::min(sensor[k], end[k]) / edge);
      high[static_cast<std::size_t>(2 - k)] = floor_of(std::max(sensor[k], end[k]) / edge);
    }
    for (int z = low[0]; z <= high[0]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[2]; x <= high[2]; ++x) {
          if (touched_.count({z, y, x}) != 0) continue;
          double near = 0.0, far = 1.0;
          const std::array<int, 3> at = {x, y, z};
          for (Eigen::Index k = 0; k < 3; ++k) {
            const double a = (at[static_cast<std::size_t>(k)] * edge - sensor[k]);
            const double whole = end[k] - sensor[k];
            near = std::max(near, std::min(a / whole, (a + edge) / whole));
            far = std::min(far, std::max(a / whole, (a + edge) / whole));
          }
          if (near <= far) touched_.insert({z, y, x});
        }
      }
    }
  }
}

void Oracle::integrate(const Scan& scan) {
  touch(scan);
  const std::vector<float> image = image_of(scan);
  for (const Cell& at : touched_) {
    const auto [found, is_new] = blocks_.try_emplace(at);
    for (int i = 0; is_new && i < kBlockSide * kBlockSide * kBlockSide; ++i) {
      const Cell cell = {at[0] * kBlockSide + i / 256, at[1] * kBlockSide + i / 16 % 16,
                         at[2] * kBlockSide + i % 16};
      found->second[cell] = {};
    }
    for (auto& [cell, voxel] : found->second) update(scan, image, cell, voxel);
  }
}

}  // namespace raymoval::dynablox_test
