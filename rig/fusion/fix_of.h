// What a tracker's sample tells the fusion.
#pragma once

#include <Eigen/Core>

#include "calibration/fusion/fusion.h"
#include "signal/pose_sample.h"
#include "signal/position_sample.h"

namespace fude {

// In the tracker's frame, with the covariance that the sample states, else with 1 mm and 10 mrad. The tool's
// axes are taken for the sensor's.
PoseFix fix_of(const PoseSample& sample);
PointFix fix_of(const PositionSample& sample);
// A fusion's covariance has the place before the rotation, a sample's the rotation before the place; it takes
// one to the other, and back.
Eigen::Matrix<double, 6, 6> rotation_first(const Eigen::Matrix<double, 6, 6>& place_first);

// The place alone.
PointFix point_of(const PoseFix& pose);

// What a fusion is made of. Where a unit sits beside a tracker's point, how late the tracker is and how late
// the gyroscope is found out.
struct FusionRig {
  Eigen::Vector3d up{0, 0, 1};   // in the world
  bool inertial = false;         // an inertial unit
  bool tracker = false;          // whose samples show another point than the unit, at another time
  bool tracker_in_time = false;  // its delay is calibrated
  bool north_is_y = false;       // in the world: a magnetometer tells the heading
};
FusionSettings fusion_settings(const FusionRig& rig);

}  // namespace fude
