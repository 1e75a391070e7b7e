// SPDX-License-Identifier: MIT
//
// Compares sequences whose rings are stored one after another, as KITTI's are, typically a
// simulated one with a real drive:
//   realism FOLDER [FOLDER ...] [--scan N] [--pictures PREFIX]
// Prints a table in Markdown, one column a folder; with --pictures also writes
// PREFIX<k>_top.png (heights seen from above, 100 m a side) and PREFIX<k>_range.png (range image),
// in the same colours for every folder.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "benchmark/picture/canvas/png_file.h"
#include "core/error.h"
#include "core/scan/voxel_key.h"
#include "core/text.h"
#include "datasets/open_sequence.h"

namespace {

using raymoval::VoxelSet;

/// A scan with a label of each point: whether it moves.
struct Cloud : raymoval::Scan {
  std::vector<bool> moving;
};

Cloud load(const raymoval::Sequence& sequence, std::size_t i) {
  Cloud cloud{sequence.scans->load(i), {}};
  for (const std::uint32_t label : sequence.labels->labels(cloud)) {
    cloud.moving.push_back(sequence.label_rule.classify(label) == raymoval::LabelClass::kMoving);
  }
  return cloud;
}

/// Rings as KITTI stores them: one after another, each from straight ahead all around to the left.
std::vector<std::size_t> ring_starts(const Cloud& cloud) {
  std::vector<std::size_t> starts = {0};
  for (std::size_t i = 1; i < cloud.points.size(); ++i) {
    const auto& a = cloud.points[i - 1];
    const auto& b = cloud.points[i];
    if (a.y() < 0 && b.y() >= 0 && b.x() > 0) starts.push_back(i);
  }
  starts.push_back(cloud.points.size());
  return starts;
}

/// Sums over the scans of a folder.
struct Statistics {
  double scans = 0, points = 0, moving = 0, ground = 0, voxels = 0, rings = 0, top = 0, bottom = 0;
  std::array<double, 7> near{};  ///< Share of points nearer than 5, 10, 15, 20, 30, 50, 80 m.
  std::vector<double> gaps;      ///< Between neighbours along a ring, metres.
  std::vector<double> jumps;     ///< Second difference of range along a ring, metres.
  VoxelSet all;
};

constexpr std::array<double, 7> kLimits = {5, 10, 15, 20, 30, 50, 80};

/// Ground without labels: the lowest point of each 1 m column, and what lies within 0.2 m above.
double ground_share(const Cloud& cloud) {
  std::map<std::pair<int, int>, float> lowest;
  const auto column = [](const Eigen::Vector3f& p) {
    return std::pair(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())));
  };
  for (const auto& p : cloud.points) {
    const auto [it, fresh] = lowest.try_emplace(column(p), p.z());
    it->second = std::min(it->second, p.z());
  }
  double count = 0;
  for (const auto& p : cloud.points) {
    count += p.z() < -0.9F && p.z() < lowest[column(p)] + 0.2F ? 1 : 0;
  }
  return count / static_cast<double>(cloud.points.size());
}

void add_rings(Statistics& s, const Cloud& cloud) {
  const auto starts = ring_starts(cloud);
  s.rings += static_cast<double>(starts.size()) - 1.0;
  const std::size_t rings = starts.size() - 1;
  for (std::size_t r = 0; r < rings; ++r) {
    const double length = static_cast<double>(starts[r + 1] - starts[r]);
    if (r < 8) s.top += length / 8.0;
    if (r + 8 >= rings) s.bottom += length / 8.0;
    for (std::size_t i = starts[r] + 1; i + 1 < starts[r + 1]; i += 7) {
      const auto& p = cloud.points[i];
      s.gaps.push_back((p - cloud.points[i - 1]).norm());
      const double second =
          0.5 * (cloud.points[i - 1].norm() + cloud.points[i + 1].norm()) - p.norm();
      s.jumps.push_back(std::abs(second));
    }
  }
}

void add_scan(Statistics& s, const Cloud& cloud) {
  const auto count = static_cast<double>(cloud.points.size());
  s.scans += 1;
  s.points += count;
  s.ground += ground_share(cloud);
  VoxelSet own;
  double moving = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d world = cloud.T_world_sensor * cloud.points[i].cast<double>();
    const auto key = raymoval::voxel_key(raymoval::voxel_index(world, 5.0));
    own.insert(key);
    s.all.insert(key);
    moving += cloud.moving[i] ? 1 : 0;
    const double range = cloud.points[i].norm();
    for (std::size_t k = 0; k < kLimits.size(); ++k) s.near[k] += range < kLimits[k] ? 1 : 0;
  }
  s.moving += moving;
  s.voxels += static_cast<double>(own.size());
  add_rings(s, cloud);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

struct Row {
  std::string name;
  std::function<std::string(const Statistics&)> text;
};

std::vector<Row> rows() {
  using raymoval::fixed_text;
  const auto a_scan = [](double Statistics::*sum, int decimals) {
    return [=](const Statistics& s) { return fixed_text(s.*sum / s.scans, decimals); };
  };
  std::vector<Row> list = {
      {"points a scan", a_scan(&Statistics::points, 0)},
      {"directions without return, % of 64 x 2083",
       [](const Statistics& s) {
         return fixed_text(100.0 - 100.0 * s.points / s.scans / (64 * 2083.0), 1);
       }},
      {"rings", a_scan(&Statistics::rings, 1)},
      {"points a ring, top eight", a_scan(&Statistics::top, 0)},
      {"points a ring, bottom eight", a_scan(&Statistics::bottom, 0)},
      {"ground, % of points",
       [](const Statistics& s) { return fixed_text(100 * s.ground / s.scans, 1); }},
      {"moving, % of points",
       [](const Statistics& s) { return fixed_text(100 * s.moving / s.points, 2); }},
      {"occupied 0.2 m voxels a scan", a_scan(&Statistics::voxels, 0)},
      {"occupied 0.2 m voxels, per scan of sequence",
       [](const Statistics& s) {
         return fixed_text(static_cast<double>(s.all.size()) / s.scans, 0);
       }},
      {"neighbour distance, median, m",
       [](const Statistics& s) { return fixed_text(quantile(s.gaps, 0.5), 3); }},
      {"neighbour distance, 90th percentile, m",
       [](const Statistics& s) { return fixed_text(quantile(s.gaps, 0.9), 3); }},
      {"range against mean of neighbours, median, m",
       [](const Statistics& s) { return fixed_text(quantile(s.jumps, 0.5), 4); }},
      {"range against mean of neighbours, 90th percentile, m",
       [](const Statistics& s) { return fixed_text(quantile(s.jumps, 0.9), 3); }}};
  for (std::size_t k = 0; k < kLimits.size(); ++k) {
    list.push_back(
        {"points nearer than " + raymoval::number_text(kLimits[k]) + " m, %",
         [k](const Statistics& s) { return fixed_text(100 * s.near[k] / s.points, 1); }});
  }
  return list;
}

/// Blue over green to red for 0 .. 1; moving points are white.
raymoval::Colour colour(double value, bool moving) {
  if (moving) return {255, 255, 255};
  const double v = std::clamp(value, 0.0, 1.0);
  const auto channel = [&](double centre) {
    return static_cast<std::uint8_t>(255 * std::clamp(1.5 - std::abs(4 * v - centre), 0.0, 1.0));
  };
  return {channel(3), channel(2), channel(1)};
}

void draw(const Cloud& cloud, const std::string& prefix) {
  raymoval::Canvas top(1000, 1000);
  raymoval::Canvas range(2083, 4 * 64);
  top.fill(0, 0, top.width(), top.height(), {});
  range.fill(0, 0, range.width(), range.height(), {});
  std::vector<std::size_t> order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cloud.points[a].z() < cloud.points[b].z();
  });
  for (const std::size_t i : order) {
    const auto& p = cloud.points[i];
    top.fill(static_cast<int>(500 - 10 * p.y()), static_cast<int>(500 - 10 * p.x()), 1, 1,
             colour((p.z() + 2.0) / 5.0, cloud.moving[i]));
  }
  const auto starts = ring_starts(cloud);
  for (std::size_t r = 0; r + 1 < starts.size(); ++r) {
    for (std::size_t i = starts[r]; i < starts[r + 1]; ++i) {
      const auto& p = cloud.points[i];
      const double turn = 0.5 - std::atan2(p.y(), p.x()) / (2 * 3.14159265358979);
      range.fill(static_cast<int>(turn * 2083), 4 * static_cast<int>(r), 1, 4,
                 colour(std::sqrt(p.norm() / 60.0), cloud.moving[i]));
    }
  }
  raymoval::write_png(prefix + "_top.png", top);
  raymoval::write_png(prefix + "_range.png", range);
}

int run(const std::vector<std::string>& arguments) {
  std::vector<std::string> folders;
  std::size_t picture_scan = 50;
  std::string prefix;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--scan") {
      picture_scan = raymoval::parse_number<std::size_t>(arguments.at(++i)).value();
    } else if (arguments[i] == "--pictures") {
      prefix = arguments.at(++i);
    } else {
      folders.push_back(arguments[i]);
    }
  }
  std::vector<Statistics> all(folders.size());
  for (std::size_t k = 0; k < folders.size(); ++k) {
    const raymoval::Sequence sequence = raymoval::open_sequence(folders[k], {});
    if (sequence.labels == nullptr) throw raymoval::DataError(folders[k] + ": has no labels.");
    const std::size_t count = sequence.scans->size();
    for (std::size_t i = 0; i < count; ++i) add_scan(all[k], load(sequence, i));
    const std::size_t shown = std::min(picture_scan, count - 1);
    if (!prefix.empty()) draw(load(sequence, shown), prefix + std::to_string(k));
  }
  std::cout << "| |";
  for (const std::filesystem::path folder : folders) {
    std::cout << " " << folder.filename().string() << " |";
  }
  std::cout << "\n|---|";
  for (std::size_t k = 0; k < folders.size(); ++k) std::cout << "---:|";
  std::cout << "\n";
  for (const Row& row : rows()) {
    std::cout << "| " << row.name << " |";
    for (const Statistics& s : all) std::cout << " " << row.text(s) << " |";
    std::cout << "\n";
  }
  return 0;
}

}  // namespace

int main(int count, char** values) {
  try {
    return run({values + 1, values + count});
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
