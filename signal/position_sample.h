// Where a single marker was: three coordinates and no orientation.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "signal/timestamp.h"

namespace fude {

struct PositionSample {
  SampleTime time;
  std::string marker;
  Eigen::Vector3d tracker_from_marker_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix3d> covariance_m2;
  std::optional<double> residual_m;
  bool valid = true;
  bool after_gap = false;
};

}  // namespace fude
