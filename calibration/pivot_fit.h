// The tip of a tool that turned about it: three fits. Frames as in signal/pose_sample.h; metres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "signal/pose_sample.h"

namespace fude {

using ToolPose = Pose<Tracker, Tool>;

struct PivotFit {
  Eigen::Vector3d tip_m = Eigen::Vector3d::Zero();    // in Tool
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();  // in Tracker: what the tip stood on
};

// R·tip + t − pivot of a pose.
Eigen::Vector3d residual_of(const PivotFit& fit, const ToolPose& pose);

// Least squares over R·tip − pivot = −t in one step, linear in both (Yaniv 2015, "algebraic one step").
// At least three poses; with a condition that is not finite the answer is one of many.
PivotFit algebraic_pivot(std::span<const ToolPose> poses);

// The tool's origin lies on a sphere about the pivot: the sphere by least squares of distances, the tip as
// the mean of the pivot seen from the tool. Worse where little of the sphere was visited.
PivotFit sphere_pivot(std::span<const ToolPose> poses);

// Ratio of the largest to the smallest singular value of the algebraic equations. It depends on the
// rotations alone: with R the mean of all, √((1 + σ)/(1 − σ)), σ its largest singular value. Turning about
// one axis only leaves σ at 1 and the tip free along that axis.
double pivot_condition(std::span<const ToolPose> poses);

struct RobustPivot {
  PivotFit fit;              // the algebraic one over those that agree
  std::vector<bool> agrees;  // a pose each
  double scale_m = 0;        // standard deviation of a coordinate, from the median
};

// The solution to which half of the poses come nearest (from small draws of a seeded generator), then
// refitted over all within four standard deviations until these stay the same.
RobustPivot robust_pivot(std::span<const ToolPose> poses);

}  // namespace fude
