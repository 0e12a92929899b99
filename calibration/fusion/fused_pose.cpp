#include "calibration/fusion/fused_pose.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double longest_unit_delay_s = 0.003;
// Data sheets have 1 to 5 ms at the usual bandwidths.
constexpr double least_unit_delay_s = 0.001;

}  // namespace

double inertial_delay(double lag_s) {
  const double share = std::clamp(2 - std::abs(lag_s) / longest_unit_delay_s, 0.0, 1.0);
  return share * -lag_s + (1 - share) * least_unit_delay_s;
}

FusedPose pose_of(const MotionState& motion, const Eigen::Vector3d& rate_radps) {
  FusedPose pose;
  const double ahead_s = inertial_delay(motion.lag_s);
  const Eigen::Vector3d turning = motion.world_from_sensor * rate_radps;
  const Eigen::Vector3d lever = motion.world_from_sensor * motion.lever_m;
  pose.rate_radps = rate_radps;
  pose.velocity_mps = motion.velocity_mps + turning.cross(lever);
  pose.point_m = motion.tracked_point_m() + ahead_s * pose.velocity_mps;
  pose.world_from_sensor = motion.world_from_sensor * rotation_of(ahead_s * rate_radps);

  constexpr double small_s = 1e-6;
  const double ahead_by_lag = (inertial_delay(motion.lag_s + small_s) - ahead_s) / small_s;
  Eigen::Matrix<double, 6, error::size> jacobian = Eigen::Matrix<double, 6, error::size>::Zero();
  jacobian.block<3, 3>(0, error::position).setIdentity();
  jacobian.block<3, 3>(0, error::turn) = -cross_matrix(lever);
  jacobian.block<3, 3>(0, error::lever) = motion.world_from_sensor.toRotationMatrix();
  jacobian.block<3, 1>(0, error::lag) = ahead_by_lag * pose.velocity_mps;
  jacobian.block<3, 3>(3, error::turn).setIdentity();
  jacobian.block<3, 1>(3, error::lag) = ahead_by_lag * turning;
  pose.covariance = jacobian * motion.covariance * jacobian.transpose();
  return pose;
}

}  // namespace fude
