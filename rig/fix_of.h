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
// The place alone.
PointFix point_of(const PoseFix& pose);

// Of a filter in a tracker's frame whose axis `up` points up. With an inertial unit beside the tracker, where
// it sits and how late the tracker is are found out; `use_field` where north is known to be the frame's y.
FusionSettings fusion_settings(const Eigen::Vector3d& up, bool inertial, bool use_field);

}  // namespace fude
