#include "calibration/fusion/motion_state.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double scale_correlation_s = 0.1;
constexpr double most_rate_change_radps = 20;  // from one reading to the next

// The blocks of a step's transition that are not the identity.
struct Step {
  double s = 0;
  Eigen::Matrix3d velocity_turn = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();  // times −s: velocity by accel, turn by gyro
  Eigen::Vector3d turn_gyro_lag = Eigen::Vector3d::Zero(), velocity_gyro_lag = Eigen::Vector3d::Zero();
  bool inertial = false;
};

// Rows of the left factor; each block reads rows that are not yet changed.
template <class Matrix>
void multiply_left(const Step& step, Matrix&& m) {
  m.template middleRows<3>(error::position) += step.s * m.template middleRows<3>(error::velocity);
  if (!step.inertial) return;
  m.template middleRows<3>(error::velocity) += step.velocity_turn * m.template middleRows<3>(error::turn) -
                                               step.rotation * m.template middleRows<3>(error::accel) +
                                               step.velocity_gyro_lag * m.row(error::gyro_lag);
  m.template middleRows<3>(error::turn) -= step.rotation * m.template middleRows<3>(error::gyro);
  m.template middleRows<3>(error::turn) += step.turn_gyro_lag * m.row(error::gyro_lag);
}

void carry(ErrorMatrix& covariance, const Step& step, ErrorMatrix* transition) {
  multiply_left(step, covariance);
  // P is symmetric: the columns of Φ P Φᵀ are the rows of Φ (Φ P)ᵀ.
  covariance.transposeInPlace();
  multiply_left(step, covariance);
  if (transition != nullptr) multiply_left(step, *transition);
}

void add_noise(ErrorMatrix& covariance, int at, double variance) {
  covariance.diagonal().segment<3>(at).array() += variance;
}

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  const double s = angle < 1e-6 ? 0.5 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * turn_rad.x(), s * turn_rad.y(), s * turn_rad.z()};
}

Eigen::Vector3d turn_of(const Eigen::Quaterniond& rotation) {
  const double sine = rotation.vec().norm();
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double angle = 2 * std::atan2(sine, std::abs(rotation.w()));
  return rotation.vec() * (sign * (sine < 1e-9 ? 2 : angle / sine));
}

void MotionState::add(const ErrorVector& e) {
  position_m += e.segment<3>(error::position);
  velocity_mps += e.segment<3>(error::velocity);
  world_from_sensor = (rotation_of(e.segment<3>(error::turn)) * world_from_sensor).normalized();
  gyro_bias_radps += e.segment<3>(error::gyro);
  accel_bias_mps2 += e.segment<3>(error::accel);
  lever_m += e.segment<3>(error::lever);
  lag_s += e[error::lag];
  gyro_lag_s += e[error::gyro_lag];
}

ErrorVector difference(const MotionState& to, const MotionState& from) {
  ErrorVector e;
  e << to.position_m - from.position_m, to.velocity_mps - from.velocity_mps,
      turn_of(to.world_from_sensor * from.world_from_sensor.conjugate()),
      to.gyro_bias_radps - from.gyro_bias_radps, to.accel_bias_mps2 - from.accel_bias_mps2,
      to.lever_m - from.lever_m, to.lag_s - from.lag_s, to.gyro_lag_s - from.gyro_lag_s;
  return e;
}

void advance(MotionState& state, const InertialInput& input, double step_s, const MotionNoise& noise,
             ErrorMatrix* transition) {
  const Eigen::Vector3d rate = input.turn_rate_radps - state.gyro_bias_radps;
  const Eigen::Vector3d force = input.specific_force_mps2 - state.accel_bias_mps2;
  const Eigen::Quaterniond half =
      rotation_of((rate * step_s + input.rate_change_radps * state.gyro_lag_s) / 2);
  const Eigen::Quaterniond middle = state.world_from_sensor * half;
  const Eigen::Matrix3d rotation = middle.toRotationMatrix();
  const Eigen::Vector3d pushed = rotation * force;
  const Eigen::Vector3d acceleration = pushed + noise.gravity_mps2;
  state.position_m += step_s * state.velocity_mps + (step_s * step_s / 2) * acceleration;
  state.velocity_mps += step_s * acceleration;
  state.world_from_sensor = (middle * half).normalized();

  Step step{.s = step_s, .rotation = rotation * step_s, .inertial = true};
  step.turn_gyro_lag = rotation * input.rate_change_radps;
  step.velocity_gyro_lag = step.turn_gyro_lag.cross(pushed) * (step_s / 2);
  step.velocity_turn = cross_matrix(-step_s * pushed);
  carry(state.covariance, step, transition);
  const auto scaled = [](double share, double size) { return share * share * size * scale_correlation_s; };
  ErrorMatrix& p = state.covariance;
  add_noise(
      p, error::velocity,
      step_s * (noise.accel_mps2 * noise.accel_mps2 + scaled(noise.accel_scale, acceleration.squaredNorm())));
  add_noise(p, error::turn,
            step_s * (noise.gyro_radps * noise.gyro_radps + scaled(noise.gyro_scale, rate.squaredNorm())));
  // Where the rate leaps as no hand turns, it was a slip or a knock: what it was over the step nobody knows.
  if (const double leap = input.rate_change_radps.norm(); leap > most_rate_change_radps)
    add_noise(p, error::turn, leap * leap * step_s * step_s);
  add_noise(p, error::gyro, step_s * noise.gyro_walk * noise.gyro_walk);
  add_noise(p, error::accel, step_s * noise.accel_walk * noise.accel_walk);
}

void coast(MotionState& state, double step_s, const MotionNoise& noise, ErrorMatrix* transition) {
  state.position_m += step_s * state.velocity_mps;
  carry(state.covariance, {.s = step_s}, transition);
  ErrorMatrix& p = state.covariance;
  const double q = noise.coast_mps2 * noise.coast_mps2;  // white acceleration over the step
  add_noise(p, error::velocity, step_s * q);
  add_noise(p, error::position, step_s * step_s * step_s / 3 * q);
  for (int i = 0; i < 3; ++i) {
    p(error::position + i, error::velocity + i) += step_s * step_s / 2 * q;
    p(error::velocity + i, error::position + i) += step_s * step_s / 2 * q;
  }
  add_noise(p, error::turn, step_s * noise.coast_radps * noise.coast_radps);
}

}  // namespace fude
