#include "rig/fusion/fix_of.h"

namespace fude {
namespace {

constexpr double position_sigma_m = 1e-3, turn_sigma_rad = 1e-2;  // of trackers that state none

}  // namespace

PoseFix fix_of(const PoseSample& sample) {
  PoseFix pose{.point_m = sample.tracker_from_tool.translation,
               .world_from_sensor = sample.tracker_from_tool.rotation};
  if (sample.covariance) {
    pose.covariance = rotation_first(*sample.covariance);
  } else {
    pose.covariance.diagonal().head<3>().setConstant(position_sigma_m * position_sigma_m);
    pose.covariance.diagonal().tail<3>().setConstant(turn_sigma_rad * turn_sigma_rad);
  }
  return pose;
}

PointFix fix_of(const PositionSample& sample) {
  const Eigen::Matrix3d covariance =
      sample.covariance_m2.value_or(Eigen::Matrix3d::Identity() * position_sigma_m * position_sigma_m);
  return {.point_m = sample.tracker_from_marker_m, .covariance_m2 = covariance};
}

PointFix point_of(const PoseFix& pose) {
  return {.point_m = pose.point_m, .covariance_m2 = pose.covariance.topLeftCorner<3, 3>()};
}

Eigen::Matrix<double, 6, 6> rotation_first(const Eigen::Matrix<double, 6, 6>& place_first) {
  Eigen::Matrix<double, 6, 6> turned;
  turned << place_first.bottomRightCorner<3, 3>(), place_first.bottomLeftCorner<3, 3>(),
      place_first.topRightCorner<3, 3>(), place_first.topLeftCorner<3, 3>();
  return turned;
}

FusionSettings fusion_settings(const FusionRig& rig) {
  FusionSettings settings;
  settings.noise.gravity_mps2 = -9.81 * rig.up.normalized();
  settings.world_from_earth = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), rig.up);
  settings.use_field = rig.north_is_y;
  if (rig.inertial) settings.gyro_lag_sigma_s = 0.001;
  if (rig.inertial && rig.tracker) {
    settings.lever_sigma_m = 0.05;
    settings.lag_sigma_s = rig.tracker_in_time ? 0.002 : 0.01;
  }
  return settings;
}

}  // namespace fude
