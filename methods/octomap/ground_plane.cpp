// SPDX-License-Identifier: MIT
#include "methods/octomap/point_filters.h"

#if RAYMOVAL_PCL
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_perpendicular_plane.h>

#include <memory>

namespace raymoval::octomap_method {
namespace {

/// PCL's plane nearly perpendicular to an axis. PCL writes a line to standard error for each sample
/// on one line; this passes over such a sample in silence.
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
  if (points.size() < static_cast<std::size_t>(parameters.ground_points)) return ground;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(points.size());
  for (const octomap::point3d& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  // What pcl::SACSegmentation does, without the lines that it prints where it finds nothing.
  const std::shared_ptr<LevelPlane> plane(new LevelPlane(cloud, false));
  plane->setAxis(Eigen::Vector3f::UnitZ());
  plane->setEpsAngle(parameters.ground_angle);
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(plane, parameters.ground_distance);
  consensus.setMaxIterations(parameters.ground_iterations);
  consensus.setProbability(parameters.ground_probability);
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

}  // namespace raymoval::octomap_method
#else
#include "core/error.h"

namespace raymoval::octomap_method {

Mask find_ground(const std::vector<octomap::point3d>& /*points*/,
                 const Parameters& /*parameters*/) {
  throw ConfigurationError(
      "octomap:ground and octomap:ground-noise (ground = true) need PCL, and this program was "
      "built "
      "without it. Install libpcl-dev and configure with -DRAYMOVAL_PCL=ON, or choose "
      "octomap:kth.");
}

}  // namespace raymoval::octomap_method
#endif
