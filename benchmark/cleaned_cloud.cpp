// SPDX-License-Identifier: MIT
#include "benchmark/cleaned_cloud.h"

#include <algorithm>
#include <tuple>

#include "benchmark/map_cleaner.h"
#include "core/text.h"
#include "datasets/cloud_file.h"

namespace raymoval {

std::vector<std::string> CleanedCloud::warnings() const {
  std::vector<std::string> warnings;
  if (non_finite > 0) {
    warnings.push_back(grouped_text(non_finite) + " of " + grouped_text(stored) +
                       " points of the cloud have a coordinate that is no finite number; they "
                       "count for nothing");
  }
  if (points.empty()) {
    warnings.push_back("the cloud has no point: all that was there counts as removed");
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

CleanedCloud read_cleaned_cloud(const std::filesystem::path& path) {
  return cleaned_cloud(read_cloud(path).points);
}

CleanedCloud oracle_cloud(const Sequence& sequence, double voxel_size, Progress* progress) {
  MapCollector kept(voxel_size);
  const ScanSource& scans = *sequence.scans;
  if (progress != nullptr) progress->begin("the oracle's cloud", scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    const std::vector<std::uint32_t> words = sequence.labels->labels(scan);
    Mask mask(words.size());
    std::transform(words.begin(), words.end(), mask.begin(), [&](std::uint32_t word) {
      return sequence.label_rule.classify(word) == LabelClass::kMoving ? 1 : 0;
    });
    kept.add(scan, mask, 0);
    if (progress != nullptr) progress->advance();
  }
  if (progress != nullptr) progress->end();
  return cleaned_cloud(kept.points());
}

}  // namespace raymoval
