// What the fusion says of the brush at one moment.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "calibration/fusion/motion_filter.h"
#include "signal/timestamp.h"

namespace fude {

struct FusedPose {
  Timestamp time{};
  FusionState state = FusionState::lost;
  bool placed = false;                                     // else the position says nothing
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();       // the tracked point, in the world
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  // of it
  Eigen::Quaterniond world_from_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();                          // in the sensor's frame
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // point m², turn rad²; world
};

// How long before their stamps an inertial unit's readings are true, where a tracker's samples lag by `lag_s`
// behind them. A difference of up to 3 ms is the delay of the unit's own low-pass filters, and the tracker
// keeps time. From 6 ms on it is the tracker's; of the unit then only what such filters delay at the least is
// assumed.
double inertial_delay(double lag_s);

// Of a filter's state that turns by `rate_radps` (sensor), ahead by the unit's delay. Time, state and
// `placed` are the caller's.
FusedPose pose_of(const MotionState& motion, const Eigen::Vector3d& rate_radps);

}  // namespace fude
