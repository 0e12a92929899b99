#include "rig/fix_of.h"

namespace fude {
namespace {

constexpr double position_sigma_m = 1e-3, turn_sigma_rad = 1e-2;  // of trackers that state none

}  // namespace

PoseFix fix_of(const PoseSample& sample) {
  PoseFix pose{.point_m = sample.tracker_from_tool.translation,
               .world_from_sensor = sample.tracker_from_tool.rotation};
  if (sample.covariance) {
    pose.covariance.topLeftCorner<3, 3>() = sample.covariance->bottomRightCorner<3, 3>();
    pose.covariance.bottomRightCorner<3, 3>() = sample.covariance->topLeftCorner<3, 3>();
    pose.covariance.topRightCorner<3, 3>() = sample.covariance->bottomLeftCorner<3, 3>();
    pose.covariance.bottomLeftCorner<3, 3>() = sample.covariance->topRightCorner<3, 3>();
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

FusionSettings fusion_settings(const Eigen::Vector3d& up, bool inertial, bool use_field) {
  FusionSettings settings;
  settings.noise.gravity_mps2 = -9.81 * up.normalized();
  settings.world_from_earth = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  settings.use_field = use_field;
  if (inertial) {
    settings.lever_sigma_m = 0.05;
    settings.lag_sigma_s = 0.01;
  }
  return settings;
}

}  // namespace fude
