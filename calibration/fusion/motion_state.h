// What the fusion knows of a moving sensor, and how well: a point on the pose manifold with the covariance of
// its error.
//
// World: right-handed, metres; gravity points along −z of earth, which MotionNoise turns into the world.
// Sensor: the inertial unit's frame. The error of a rotation is a small turn about the WORLD's axes: true =
// exp(error) · estimate; all other errors are true − estimate.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fude {

namespace error {
inline constexpr int position = 0, velocity = 3, turn = 6, gyro = 9, accel = 12, lever = 15, lag = 18,
                     gyro_lag = 19;
inline constexpr int size = 20;
}  // namespace error

using ErrorVector = Eigen::Matrix<double, error::size, 1>;
using ErrorMatrix = Eigen::Matrix<double, error::size, error::size>;

struct MotionState {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the accelerometer, in the world
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond world_from_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_m = Eigen::Vector3d::Zero();  // the point that a tracker sees, in the sensor's frame
  double lag_s = 0;       // a tracker's samples show where it was this long before their stamps
  double gyro_lag_s = 0;  // and the gyroscope's what turned this long before the accelerometer's of its stamp
  ErrorMatrix covariance = ErrorMatrix::Zero();

  Eigen::Vector3d tracked_point_m() const { return position_m + world_from_sensor * lever_m; }

  void add(const ErrorVector& e);
};

// The error that takes `from` to `to`.
ErrorVector difference(const MotionState& to, const MotionState& from);

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& turn_rad);
Eigen::Vector3d turn_of(const Eigen::Quaterniond& rotation);  // shorter way round
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

// How inertial readings err and how a hand moves without them. Densities are per √Hz, walks per √s.
struct MotionNoise {
  Eigen::Vector3d gravity_mps2{0, 0, -9.81};  // in the world
  double gyro_radps = 2e-4;                   // white noise density of the turn rate
  double gyro_scale = 3e-3;   // share of the rate by which scale and axes are off, taken as white over 0.1 s
  double accel_mps2 = 1e-2;   // white noise density of the specific force, vibration of a handle included
  double accel_scale = 3e-3;  // share of the force beyond gravity, likewise
  double gyro_walk = 2e-5;    // rad/s per √s
  double accel_walk = 1e-3;   // m/s² per √s
  double coast_mps2 = 3;      // density of a hand's acceleration where no inertial sample says it
  double coast_radps = 2;     // density of its turn rate
};

struct InertialInput {
  Eigen::Vector3d turn_rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_change_radps = Eigen::Vector3d::Zero();  // since the reading before
};

// The state `step_s` (> 0) later. All of it is of the accelerometer's time: what a gyroscope that lags has
// not told yet is what it would turn at its rate, so a change of the rate turns by lag times change. Where
// `transition` is given, the step's error transition is multiplied onto it from the left.
void advance(MotionState& state, const InertialInput& input, double step_s, const MotionNoise& noise,
             ErrorMatrix* transition = nullptr);

// The same with no inertial sample: velocity and rotation stay, and grow uncertain.
void coast(MotionState& state, double step_s, const MotionNoise& noise, ErrorMatrix* transition = nullptr);

}  // namespace fude
