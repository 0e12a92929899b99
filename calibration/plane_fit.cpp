#include "calibration/plane_fit.h"

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "calibration/report.h"

namespace fude {
namespace {

double median_distance(const PlaneFit& plane, std::span<const Eigen::Vector3d> points, std::size_t stride) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); i += stride)
    distances.push_back(std::abs(plane.distance(points[i])));
  return quantile(std::move(distances), 0.5);
}

}  // namespace

PlaneFit fit_plane(std::span<const Eigen::Vector3d> points) {
  PlaneFit plane;
  const double n = double(points.size());
  for (const Eigen::Vector3d& p : points) plane.centre += p / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - plane.centre) * (p - plane.centre).transpose() / n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  plane.normal = solver.eigenvectors().col(0);
  plane.along = solver.eigenvectors().col(2);
  plane.spread = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  return plane;
}

RobustPlane robust_plane(std::span<const Eigen::Vector3d> points, double finest) {
  constexpr int draws = 300;
  constexpr std::size_t most_judges = 600;
  constexpr double median_of_one = 0.6745;
  constexpr double gate = 4;
  const double few = 1 + 5 / std::max(1.0, double(points.size()) - 3);  // Rousseeuw 1984
  const std::size_t stride = points.size() / most_judges + 1;
  RobustPlane robust{fit_plane(points), std::vector<bool>(points.size(), true), 0};
  const PlaneFit whole = robust.plane;
  double least = median_distance(whole, points, stride);
  std::mt19937 random(1);
  for (int draw = 0; draw < draws; ++draw) {
    const Eigen::Vector3d some[] = {points[random() % points.size()], points[random() % points.size()],
                                    points[random() % points.size()]};
    // Points close together, or nearly on a line, say little of the plane.
    const Eigen::Vector3d area = (some[1] - some[0]).cross(some[2] - some[0]);
    if (area.norm() < 0.5 * whole.spread(0) * whole.spread(1)) continue;
    PlaneFit plane = whole;
    plane.centre = some[0];
    plane.normal = area.normalized();
    if (const double half = median_distance(plane, points, stride); half < least) {
      least = half;
      robust.plane = plane;
    }
  }
  for (int round = 0; round < 30; ++round) {
    robust.scale = std::max(finest, few * median_distance(robust.plane, points, 1) / median_of_one);
    std::vector<bool> agrees(points.size());
    std::vector<Eigen::Vector3d> near;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((agrees[i] = std::abs(robust.plane.distance(points[i])) < gate * robust.scale))
        near.push_back(points[i]);
    const bool settled = round > 0 && agrees == robust.agrees;
    robust.agrees = std::move(agrees);
    if (settled) break;
    robust.plane = fit_plane(near);
  }
  return robust;
}

}  // namespace fude
