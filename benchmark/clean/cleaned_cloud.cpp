// SPDX-License-Identifier: MIT
#include "benchmark/clean/cleaned_cloud.h"

#include <algorithm>
#include <tuple>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/scan/local_frame.h"
#include "core/scan/voxel_key.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval {

std::vector<std::string> CleanedCloud::warnings() const {
  std::vector<std::string> warnings;
  if (non_finite > 0) {
    warnings.push_back(grouped_text(non_finite) + " of " + grouped_text(stored) +
                       " points of the cloud have a coordinate that is not finite and are ignored");
  }
  if (points.empty()) {
    warnings.push_back("the cloud has no point: every point counts as removed");
  }
  return warnings;
}

CleanedCloud cleaned_cloud(std::vector<Eigen::Vector3f> points) {
  CleanedCloud cloud;
  cloud.stored = points.size();
  std::erase_if(points, [](const Eigen::Vector3f& point) { return !point.allFinite(); });
  cloud.non_finite = cloud.stored - points.size();
  std::sort(points.begin(), points.end(), [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
  });
  cloud.points = std::move(points);
  return cloud;
}

CleanedCloud read_cleaned_cloud(const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  if (is_folder(path)) {
    throw UsageError(path.string() + ": is a folder; expected the file of one map (.pcd, .ply, " +
                     ".bin). Label files are scored with --predictions.");
  }
  return cleaned_cloud(read_cloud(path, origin).points);
}

namespace {

/// Points of a sequence in the world frame, or their means by cell.
class MapPoints {
 public:
  explicit MapPoints(double voxel_size) : voxel_size_(voxel_size) {}
  void add(const Eigen::Vector3d& point) {
    if (voxel_size_ <= 0.0) {
      points_.push_back(point.cast<float>());
      return;
    }
    Cell& cell = cells_[voxel_key(voxel_index(point, 1.0 / voxel_size_))];
    cell.sum += point;
    ++cell.count;
  }
  /// In no particular order.
  [[nodiscard]] std::vector<Eigen::Vector3f> points() const {
    std::vector<Eigen::Vector3f> points = points_;
    for (const auto& [key, cell] : cells_) {
      const Eigen::Vector3d mean = cell.sum / static_cast<double>(cell.count);
      points.push_back(mean.cast<float>());
    }
    return points;
  }

 private:
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::uint64_t count = 0;
  };
  double voxel_size_;
  std::vector<Eigen::Vector3f> points_;
  VoxelMap<Cell> cells_;
};

/// @param moving whether moving points are part of it
CleanedCloud labelled_cloud(const Sequence& sequence, bool moving, double voxel_size,
                            Progress* progress) {
  MapPoints kept(voxel_size);
  const LocalFrameSource scans(*sequence.scans, lattice_frame(*sequence.scans));
  if (progress != nullptr) progress->begin("the oracle's cloud", scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    const std::vector<std::uint32_t> words = sequence.labels->labels(scan);
    for (std::size_t k = 0; k < words.size(); ++k) {
      if (!moving && sequence.label_rule.classify(words[k]) == LabelClass::kMoving) continue;
      kept.add(scan.T_world_sensor * scan.points[k].cast<double>());
    }
    if (progress != nullptr) progress->advance();
  }
  if (progress != nullptr) progress->end();
  return cleaned_cloud(kept.points());
}

}  // namespace

CleanedCloud oracle_cloud(const Sequence& sequence, double voxel_size, Progress* progress) {
  return labelled_cloud(sequence, false, voxel_size, progress);
}

CleanedCloud whole_cloud(const Sequence& sequence, double voxel_size, Progress* progress) {
  return labelled_cloud(sequence, true, voxel_size, progress);
}

}  // namespace raymoval
