// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/parallel.h"
#include "methods/common/point_tree.h"
#include "methods/octomap/point_filters.h"

namespace raymoval::octomap_method {
Mask find_noise(const std::vector<octomap::point3d>& points, const Parameters& parameters,
                int threads) {
  const auto neighbours = static_cast<std::size_t>(parameters.noise_neighbours);
  Mask noise(points.size(), 0);
  if (points.size() <= neighbours) return noise;
  const PointTree<octomap::point3d> tree(points);
  std::vector<double> mean_distance(points.size());
  parallel_chunks(threads, points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> index(neighbours + 1);
    std::vector<float> squared(neighbours + 1);
    for (std::size_t i = begin; i < end; ++i) {
      tree.find_nearest(points[i], index, squared);
      double sum = 0.0;  // The first neighbour is the point itself, or one in the same place.
      for (std::size_t k = 1; k <= neighbours; ++k) sum += std::sqrt(squared[k]);
      mean_distance[i] = sum / static_cast<double>(neighbours);
    }
  });
  double sum = 0.0, sum_of_squares = 0.0;
  for (const double distance : mean_distance) {
    sum += distance;
    sum_of_squares += distance * distance;
  }
  const auto count = static_cast<double>(points.size());
  const double variance = std::max(0.0, (sum_of_squares - sum * sum / count) / (count - 1.0));
  const double limit = sum / count + parameters.noise_sigma * std::sqrt(variance);
  for (std::size_t i = 0; i < points.size(); ++i) noise[i] = mean_distance[i] > limit ? 1 : 0;
  return noise;
}

}  // namespace raymoval::octomap_method
