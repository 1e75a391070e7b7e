// SPDX-License-Identifier: MIT
#include "datasets/odometry/pose_graph.h"

#include <Eigen/Geometry>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace raymoval::odometry {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMostGraphSteps = 30;
constexpr double kSmallStep = 1e-6;  // metres and radians
constexpr double kRobustSquare =
    9.0;  // Squared deviations in sigmas at which half the weight is lost.

/// Rotation and translation of a small motion: rotation vector, then metres.
Vector6d vector_of(const Pose& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  Vector6d vector;
  vector << turn.angle() * turn.axis(), motion.translation();
  return vector;
}

Pose motion_of(const Eigen::Ref<const Vector6d>& vector) {
  Pose motion = Pose::Identity();
  const Eigen::Vector3d turn = vector.head<3>();
  if (turn.norm() > 1e-12) {
    motion.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  motion.translation() = vector.tail<3>();
  return motion;
}

/// How a small motion of a frame looks from another frame, T_other_frame.
Matrix6d adjoint_of(const Pose& T) {
  Eigen::Matrix3d cross;
  const Eigen::Vector3d& t = T.translation();
  cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T.linear();
  adjoint.bottomLeftCorner<3, 3>() = cross * T.linear();
  return adjoint;
}

/// The normal equations of a graph.
class Normals {
 public:
  explicit Normals(std::size_t poses)
      : gradient_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * poses))) {}

  void add(const std::vector<Pose>& poses, const GraphEdge& edge) {
    const Pose T_from_world = edge.from ? poses[*edge.from].inverse() : Pose::Identity();
    const Vector6d error = vector_of(edge.T_from_to.inverse() * T_from_world * poses[edge.to]);
    Vector6d weights;
    weights << Eigen::Vector3d::Constant(std::pow(edge.sigma.radians, -2)),
        Eigen::Vector3d::Constant(std::pow(edge.sigma.metres, -2));
    const double square = error.dot(weights.cwiseProduct(error));
    if (edge.is_robust) weights /= 1.0 + square / kRobustSquare;
    // Motions of the poses are in their own frames: the error moves with `to`, and against `from`.
    put(edge.to, edge.to, weights.asDiagonal());
    gradient_.segment<6>(place(edge.to)) += weights.cwiseProduct(error);
    if (!edge.from) return;
    const Matrix6d back = -adjoint_of((T_from_world * poses[edge.to]).inverse());
    const Matrix6d mixed = back.transpose() * weights.asDiagonal();
    put(*edge.from, *edge.from, mixed * back);
    put(*edge.from, edge.to, mixed);
    put(edge.to, *edge.from, mixed.transpose());
    gradient_.segment<6>(place(*edge.from)) += mixed * error;
  }
  void fix_first() { put(0, 0, 1e12 * Matrix6d::Identity()); }

  [[nodiscard]] Eigen::VectorXd solved() const {
    Eigen::SparseMatrix<double> hessian(gradient_.size(), gradient_.size());
    hessian.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(hessian);
    Eigen::VectorXd step = solver.solve(-gradient_);
    if (solver.info() != Eigen::Success || !step.allFinite()) {
      throw InternalError("a pose graph does not determine its poses");
    }
    return step;
  }
  static Eigen::Index place(std::size_t pose) { return static_cast<Eigen::Index>(6 * pose); }

 private:
  void put(std::size_t row, std::size_t column, const Matrix6d& block) {
    for (int c = 0; c < 6; ++c) {
      for (int r = 0; r < 6; ++r) {
        entries_.emplace_back(place(row) + r, place(column) + c, block(r, c));
      }
    }
  }

  Eigen::VectorXd gradient_;
  std::vector<Eigen::Triplet<double, Eigen::Index>> entries_;
};

}  // namespace

std::vector<Pose> optimised(std::vector<Pose> poses, const std::vector<GraphEdge>& edges) {
  const bool is_placed =
      std::any_of(edges.begin(), edges.end(), [](const GraphEdge& edge) { return !edge.from; });
  for (int k = 0; k < kMostGraphSteps; ++k) {
    Normals normals(poses.size());
    for (const GraphEdge& edge : edges) normals.add(poses, edge);
    if (!is_placed) normals.fix_first();
    const Eigen::VectorXd step = normals.solved();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i] = poses[i] * motion_of(step.segment<6>(Normals::place(i)));
      poses[i].linear() = Eigen::Quaterniond(poses[i].linear()).normalized().toRotationMatrix();
    }
    if (step.cwiseAbs().maxCoeff() < kSmallStep) break;
  }
  return poses;
}

}  // namespace raymoval::odometry
