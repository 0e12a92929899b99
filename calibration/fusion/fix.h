// What a sensor says of the pose at one moment: the measurements that correct the fusion. Offsets are from
// the tracked point, along the sensor's axes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>

#include "calibration/fusion/motion_state.h"
#include "calibration/smooth_field.h"

namespace fude {

// Where the tracked point (MotionState::lever_m) is, or one beside it.
struct PointFix {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // world
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Identity() * 1e-6;
  std::optional<Eigen::Vector3d> offset_m;  // none: a tracker's, which may lag
};

// A point fix of the tracked point and the sensor's rotation.
struct PoseFix {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond world_from_sensor = Eigen::Quaterniond::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity() * 1e-6;  // m², then rad²
};

// One ultrasonic distance from a receiver at a known place to an emitter on the sensor's body.
struct RangeFix {
  Eigen::Vector3d receiver_m = Eigen::Vector3d::Zero();  // world
  Eigen::Vector3d emitter_offset_m = Eigen::Vector3d::Zero();
  double distance_m = 0;
  double sigma_m = 5e-4;
};

// The tip touches the surface z = height_m of the world, or a sheet over it.
struct ContactFix {
  Eigen::Vector3d tip_offset_m = Eigen::Vector3d::Zero();
  double height_m = 0;
  std::shared_ptr<const SmoothField> sheet;  // more height, mm, at the world's x and y in mm
  double sigma_m = 3e-4;
};

// Where up is, and north: from gravity and field, as OrientationFilter has them. Large sigmas, since these
// errors stay alike for seconds.
struct AttitudeFix {
  Eigen::Quaterniond world_from_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // world; what turns about it is heading
  std::optional<double> inclination_sigma_rad, heading_sigma_rad;
};

using Fix = std::variant<PointFix, PoseFix, RangeFix, ContactFix, AttitudeFix>;

// Whether every number is finite and every variance positive.
bool sound(const Fix& fix);

// Whether it says where the sensor is (all but AttitudeFix).
bool places(const Fix& fix);

// Up to six linearised rows: residual = jacobian · error + noise.
struct Innovation {
  int rows = 0;
  Eigen::Matrix<double, 6, 1> residual = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, error::size> jacobian = Eigen::Matrix<double, 6, error::size>::Zero();
  Eigen::Matrix<double, 6, 6> noise = Eigen::Matrix<double, 6, 6>::Identity();
};

// `rate_radps` (sensor) and `assumed_lag_s` serve fixes of the tracked point, which are applied at their
// stamp less that lag.
Innovation innovation_of(const Fix& fix, const MotionState& state, const Eigen::Vector3d& rate_radps,
                         double assumed_lag_s);

}  // namespace fude
