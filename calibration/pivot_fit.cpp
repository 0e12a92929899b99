#include "calibration/pivot_fit.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "calibration/report.h"

namespace fude {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Since RᵀR = 1, the normal equations are [n, −ΣRᵀ; −ΣR, n]·[tip; pivot] = [−ΣRᵀt; Σt].
struct NormalEquations {
  Matrix6 left = Matrix6::Zero();
  Vector6 right = Vector6::Zero();

  void add(const ToolPose& pose) {
    const Eigen::Matrix3d r = pose.rotation.toRotationMatrix();
    left.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
    left.bottomRightCorner<3, 3>() += Eigen::Matrix3d::Identity();
    left.topRightCorner<3, 3>() -= r.transpose();
    left.bottomLeftCorner<3, 3>() -= r;
    right.head<3>() -= r.transpose() * pose.translation;
    right.tail<3>() += pose.translation;
  }

  PivotFit solve() const {
    const Vector6 x = left.completeOrthogonalDecomposition().solve(right);
    return {x.head<3>(), x.tail<3>()};
  }
};

double median_distance(const PivotFit& fit, std::span<const ToolPose> poses, std::size_t stride) {
  std::vector<double> distances;
  distances.reserve(poses.size() / stride + 1);
  for (std::size_t i = 0; i < poses.size(); i += stride)
    distances.push_back(residual_of(fit, poses[i]).norm());
  return quantile(std::move(distances), 0.5);
}

PivotFit nearest_to_half(std::span<const ToolPose> poses) {
  constexpr int draws = 300;
  constexpr std::size_t draw_size = 5, most_judges = 600;
  const std::size_t stride = poses.size() / most_judges + 1;
  PivotFit best = algebraic_pivot(poses);
  double least = median_distance(best, poses, stride);
  std::mt19937 random(1);
  std::vector<ToolPose> some(draw_size);
  for (int draw = 0; draw < draws; ++draw) {
    for (ToolPose& pose : some) pose = poses[random() % poses.size()];
    if (pivot_condition(some) > 1e3) continue;
    const PivotFit fit = algebraic_pivot(some);
    if (const double half = median_distance(fit, poses, stride); half < least) {
      least = half;
      best = fit;
    }
  }
  return best;
}

}  // namespace

Eigen::Vector3d residual_of(const PivotFit& fit, const ToolPose& pose) {
  return pose * fit.tip_m - fit.pivot_m;
}

PivotFit algebraic_pivot(std::span<const ToolPose> poses) {
  NormalEquations equations;
  for (const ToolPose& pose : poses) equations.add(pose);
  return equations.solve();
}

PivotFit sphere_pivot(std::span<const ToolPose> poses) {
  // A first guess: |t|² = 2 t·c + k, linear in centre and k; about the mean, where numbers are small.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ToolPose& pose : poses) mean += pose.translation / double(poses.size());
  Eigen::MatrixXd a(Eigen::Index(poses.size()), 4);
  Eigen::VectorXd b(Eigen::Index(poses.size()));
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    const Eigen::Vector3d t = poses[std::size_t(i)].translation - mean;
    a.row(i) << 2 * t.transpose(), 1;
    b(i) = t.squaredNorm();
  }
  const Eigen::Vector4d guess = a.completeOrthogonalDecomposition().solve(b);
  Eigen::Vector3d centre = guess.head<3>();
  double radius = std::sqrt(std::max(0.0, guess(3) + centre.squaredNorm()));

  for (int step = 0; step < 50; ++step) {  // Gauss-Newton on the distances
    for (Eigen::Index i = 0; i < b.size(); ++i) {
      const Eigen::Vector3d out = poses[std::size_t(i)].translation - mean - centre;
      const double distance = std::max(out.norm(), 1e-12);
      a.row(i) << -(out / distance).transpose(), -1;
      b(i) = radius - distance;
    }
    const Eigen::Vector4d change = a.completeOrthogonalDecomposition().solve(b);
    centre += change.head<3>();
    radius += change(3);
    if (change.norm() < 1e-10) break;
  }
  PivotFit fit{Eigen::Vector3d::Zero(), mean + centre};
  for (const ToolPose& pose : poses) fit.tip_m += pose.inverse() * fit.pivot_m / double(poses.size());
  return fit;
}

double pivot_condition(std::span<const ToolPose> poses) {
  if (poses.empty()) return std::numeric_limits<double>::infinity();
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const ToolPose& pose : poses) mean += pose.rotation.toRotationMatrix();
  const double sigma = (mean / double(poses.size())).jacobiSvd().singularValues()(0);
  constexpr double rounding = 1e-14;
  if (1 - sigma < rounding) return std::numeric_limits<double>::infinity();
  return std::sqrt((1 + sigma) / (1 - sigma));
}

RobustPivot robust_pivot(std::span<const ToolPose> poses) {
  constexpr double median_of_three = 1.538;  // of |r| where each of three coordinates has variance 1
  constexpr double gate = 4;                 // one in a thousand of sound residuals lies beyond
  constexpr double finest_scale_m = 1e-6;    // exact data would gate its own rounding
  RobustPivot robust;
  robust.fit = nearest_to_half(poses);
  for (int round = 0; round < 30; ++round) {
    robust.scale_m = std::max(median_distance(robust.fit, poses, 1) / median_of_three, finest_scale_m);
    std::vector<bool> agrees(poses.size());
    NormalEquations equations;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      agrees[i] = residual_of(robust.fit, poses[i]).norm() < gate * robust.scale_m;
      if (agrees[i]) equations.add(poses[i]);
    }
    const bool settled = agrees == robust.agrees;
    robust.agrees = std::move(agrees);
    if (settled) break;
    robust.fit = equations.solve();
  }
  return robust;
}

}  // namespace fude
