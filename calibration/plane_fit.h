// A plane through points, and through those of many points that lie on one.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace fude {

struct PlaneFit {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit; its side is not determined
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();   // unit, the points' longest extent
  // Standard deviations of the points along `along`, across it in the plane, and off the plane.
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();

  double distance(const Eigen::Vector3d& point) const { return normal.dot(point - centre); }
};

// Least squares of distances (total least squares); three points at least.
PlaneFit fit_plane(std::span<const Eigen::Vector3d> points);

struct RobustPlane {
  PlaneFit plane;
  std::vector<bool> agrees;  // a point each
  double scale = 0;          // standard deviation of distances, from the median
};

// The plane to which half of the points are nearest (draws of three by a seeded generator), refitted over all
// within four standard deviations, which is at least `finest`.
RobustPlane robust_plane(std::span<const Eigen::Vector3d> points, double finest);

}  // namespace fude
