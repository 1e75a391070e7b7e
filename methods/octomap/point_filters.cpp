// SPDX-License-Identifier: MIT
#include "methods/octomap/point_filters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/parallel.h"
#include "core/point_tree.h"
#if RAYMOVAL_PCL
// PCL's planes are compiled here: to load its library of models would double the time that the
// program takes to start.
#define PCL_NO_PRECOMPILE
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_perpendicular_plane.h>

#include <memory>
#endif

namespace raymoval::octomap_method {
#if RAYMOVAL_PCL
namespace {

constexpr std::size_t kLeastPoints = 50;  ///< Scans with fewer points have no ground (KTH port).
constexpr int kMostTries = 50;            ///< PCL's default, as in the KTH port.

/// PCL's plane nearly perpendicular to an axis. For each sample of collinear points PCL writes a
/// line to standard error; this class skips such samples silently.
class LevelPlane : public pcl::SampleConsensusModelPerpendicularPlane<pcl::PointXYZ> {
 public:
  using Base = pcl::SampleConsensusModelPerpendicularPlane<pcl::PointXYZ>;
  using Base::Base;

 protected:
  [[nodiscard]] bool isSampleGood(const pcl::Indices& samples) const override {
    const Eigen::Vector3f a = at(samples[0]), b = at(samples[1]), c = at(samples[2]);
    return (b - a).cross(c - a).stableNorm() >= Eigen::NumTraits<float>::dummy_precision();
  }

 private:
  [[nodiscard]] Eigen::Vector3f at(int i) const {
    return (*input_)[static_cast<std::size_t>(i)].getVector3fMap();
  }
};

}  // namespace

Mask find_ground(const std::vector<octomap::point3d>& points, const Parameters& parameters) {
  Mask ground(points.size(), 0);
  if (points.size() < kLeastPoints) return ground;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(points.size());
  for (const octomap::point3d& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  // Like pcl::SACSegmentation, without its output if it finds nothing.
  const std::shared_ptr<LevelPlane> plane(new LevelPlane(cloud, false));
  plane->setAxis(Eigen::Vector3f::UnitZ());
  plane->setEpsAngle(parameters.ground_angle);
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(plane, parameters.ground_distance);
  consensus.setMaxIterations(kMostTries);
  if (!consensus.computeModel(0)) return ground;
  pcl::Indices inliers;
  Eigen::VectorXf coefficients, refined;
  consensus.getInliers(inliers);
  consensus.getModelCoefficients(coefficients);
  plane->optimizeModelCoefficients(inliers, coefficients, refined);
  plane->selectWithinDistance(refined, parameters.ground_distance, inliers);
  for (const int inlier : inliers) ground[static_cast<std::size_t>(inlier)] = 1;
  return ground;
}

#else
Mask find_ground(const std::vector<octomap::point3d>& /*points*/,
                 const Parameters& /*parameters*/) {
  throw ConfigurationError(
      "octomap:ground and octomap:ground-noise (ground = true) need PCL, and this program was "
      "built "
      "without it. Install libpcl-dev and configure with -DRAYMOVAL_PCL=ON, or choose "
      "octomap:kth.");
}

#endif

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
      const float query[3] = {points[i](0), points[i](1), points[i](2)};
      tree.find_nearest(query, index, squared);
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
