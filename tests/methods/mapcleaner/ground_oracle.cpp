// SPDX-License-Identifier: MIT
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scan/local_frame.h"
#include "tests/methods/mapcleaner/oracle.h"

namespace raymoval::mapcleaner_test {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  double sum = 0;
  for (const double value : values) sum += std::pow(value - mean_of(values), 2);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace

GroundOracle::GroundOracle(const Parameters& parameters)
    : p_(parameters),
      height_(p_.public_height ? p_.sensor_height : std::numeric_limits<double>::infinity()),
      knows_height_(p_.public_height) {}

Mask GroundOracle::ground(const Scan& scan) {
  std::map<int, Bin> of_scan = bins(scan);
  if (!knows_height_) {
    learn_height(of_scan);
    of_scan = bins(scan);
  }
  for (int ring = 0; ring < 14; ++ring) judge(ring, of_scan);
  adapt();
  Mask mask(scan.size(), 0);
  for (const auto& [number, bin] : of_scan) {
    for (const std::size_t i : bin.ground) mask[i] = 1;
  }
  return mask;
}

std::map<int, GroundOracle::Bin> GroundOracle::bins(const Scan& scan) {
  const double a = p_.ground_min_range, b = p_.ground_max_range;
  const double bounds[] = {a, (7 * a + b) / 8, (3 * a + b) / 4, (a + b) / 2, b};
  const int rings[] = {2, 4, 4, 4}, sectors[] = {16, 32, 54, 32};
  const Eigen::Matrix3d& turn = scan.T_world_sensor.linear();
  const Eigen::Matrix3d level = p_.public_axes ? turn : turn_to_z(turn.row(2).transpose());
  points_.clear();
  std::map<int, Bin> found;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    points_.push_back(level * scan.points[i].cast<double>());
    const Eigen::Vector3d& point = points_.back();
    const double distance = point.head<2>().norm();
    if (distance < a || distance > b) continue;
    const bool is_deep = point.z() < -height_ - 0.8 && point.z() / distance < std::tan(-M_PI / 12);
    if (is_deep && !scan.reflectance.empty() && scan.reflectance[i] < p_.noise_reflectance)
      continue;
    int zone = 3, before = 0;
    while (zone > 0 && distance < bounds[zone]) --zone;
    for (int k = 0; k < zone; ++k) before += rings[k];
    const double width = (bounds[zone + 1] - bounds[zone]) / rings[zone];
    const int ring = std::min(static_cast<int>((distance - bounds[zone]) / width), rings[zone] - 1);
    double turned = std::atan2(point.y(), point.x());
    if (turned < 0) turned += 2 * M_PI;
    const int sector =
        std::min(static_cast<int>(turned / (2 * M_PI / sectors[zone])), sectors[zone] - 1);
    Bin& bin = found[1000 * (before + ring) + sector];
    bin.zone = zone;
    bin.ring = before + ring;
    bin.points.push_back(i);
  }
  for (auto& [number, bin] : found) {
    if (bin.points.size() >= static_cast<std::size_t>(p_.bin_points)) fit(bin);
  }
  return found;
}

void GroundOracle::plane_of(const std::vector<std::size_t>& chosen, Bin& bin) const {
  const auto count = static_cast<double>(chosen.size());
  bin.mean.setZero();
  for (const std::size_t i : chosen) bin.mean += points_[i] / count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::size_t i : chosen) {
    covariance +=
        (points_[i] - bin.mean) * (points_[i] - bin.mean).transpose() / std::max(1.0, count - 1);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU);
  bin.spread = svd.singularValues();
  bin.normal = svd.matrixU().col(2);
  if (bin.normal.z() < 0) bin.normal = -bin.normal;
  bin.offset = -bin.normal.dot(bin.mean);
}

std::vector<std::size_t> GroundOracle::seeds(const Bin& bin, const std::vector<std::size_t>& left,
                                             double above) const {
  std::vector<double> heights;
  for (const std::size_t i : left) {
    if (bin.zone > 0 || points_[i].z() >= -1.2 * height_) heights.push_back(points_[i].z());
  }
  std::sort(heights.begin(), heights.end());
  heights.resize(std::min(heights.size(), static_cast<std::size_t>(p_.lowest_points)));
  std::vector<std::size_t> chosen;
  for (const std::size_t i : left) {
    if (heights.empty() || points_[i].z() < mean_of(heights) + above) chosen.push_back(i);
  }
  return chosen;
}

void GroundOracle::fit(Bin& bin) const {
  std::vector<std::size_t> left = bin.points;
  for (int round = 0; round < p_.plane_rounds && bin.zone == 0; ++round) {
    plane_of(seeds(bin, left, p_.wall_seed_height), bin);
    if (!(bin.normal.z() < p_.upright)) break;
    std::vector<std::size_t> rest;
    for (const std::size_t i : left) {
      if (!(std::abs(bin.normal.dot(points_[i]) + bin.offset) < p_.wall_distance))
        rest.push_back(i);
    }
    left = rest;
    if (left.empty()) return;
  }
  bin.has_plane = true;
  plane_of(seeds(bin, left, p_.seed_height), bin);
  for (int round = 0; round < p_.plane_rounds; ++round) {
    bin.ground.clear();
    for (const std::size_t i : left) {
      if (bin.normal.dot(points_[i]) + bin.offset < p_.ground_distance) bin.ground.push_back(i);
    }
    plane_of(bin.ground, bin);
  }
}

void GroundOracle::learn_height(std::map<int, Bin>& bins) {
  std::vector<double> heights;
  for (const auto& [number, bin] : bins) {
    const bool is_upright = bin.has_plane && bin.normal.z() > p_.upright;
    if (bin.zone == 0 && is_upright && bin.mean.z() < 0) heights.push_back(-bin.mean.z());
  }
  if (heights.empty()) return;
  std::sort(heights.begin(), heights.end());
  height_ = heights[heights.size() / 2];
  knows_height_ = true;
}

void GroundOracle::judge(int ring, std::map<int, Bin>& bins) {
  std::vector<double> accepted;
  std::vector<Bin*> candidates;
  for (auto& [number, bin] : bins) {
    if (bin.ring != ring || !bin.has_plane) continue;
    if (!(bin.normal.z() > p_.upright)) {
      bin.ground.clear();
      continue;
    }
    if (ring >= 4) continue;
    const bool is_low = bin.mean.z() < low_[ring], is_flat = bin.spread[2] < flat_[ring];
    if (is_low) {
      elevations_[ring].push_back(bin.mean.z());
      flatnesses_[ring].push_back(bin.spread[2]);
      accepted.push_back(bin.spread[2]);
    }
    if (!(bin.mean.dot(bin.normal) < 0)) {
      bin.ground.clear();
    } else if (!is_low && !is_flat) {
      candidates.push_back(&bin);
    }
  }
  for (Bin* bin : candidates) {
    double likeness = 0;
    if (!accepted.empty()) {
      const double mu = mean_of(accepted) + 1.5 * deviation_of(accepted);
      likeness = 1 / (1 + std::exp((bin->spread[2] - mu) / (mu / 10)));
    }
    const double own = p_.ground_distance * p_.ground_distance;
    if (bin->ground.size() > 1500 && bin->spread[2] < own) likeness = 1;
    if (bin->spread[0] / bin->spread[1] > 8) likeness = 0;
    if (!(likeness > 0.5)) bin->ground.clear();
  }
}

void GroundOracle::adapt() {
  for (int ring = 0; ring < 4; ++ring) {
    if (elevations_[ring].empty()) continue;
    const auto last = [](std::vector<double>& all) {
      if (all.size() > 1000) all.erase(all.begin(), all.end() - 1000);
    };
    last(elevations_[ring]);
    last(flatnesses_[ring]);
    const double mean = mean_of(elevations_[ring]);
    low_[ring] = mean + (ring == 0 ? 3 : 2) * deviation_of(elevations_[ring]);
    flat_[ring] = mean_of(flatnesses_[ring]) + deviation_of(flatnesses_[ring]);
    if (ring == 0) height_ = -mean;
  }
}

}  // namespace raymoval::mapcleaner_test
