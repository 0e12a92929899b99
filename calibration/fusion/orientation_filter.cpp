#include "calibration/fusion/orientation_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fude {
namespace {

constexpr double rest_time_constant_s = 0.5;
constexpr double bias_period_s = 0.1;  // between two lessons of the bias
// How far off inclination and heading usually are in motion, and at first.
constexpr double usual_inclination_rad = 0.02, first_inclination_rad = 0.1;
constexpr double usual_heading_rad = 0.04, first_heading_rad = 0.2;
constexpr double provisional_heading_s = 1;
constexpr double field_memory_s = 20;  // of the usual field's strength and dip

// The rotation vector as a quaternion; by series where it is small, as nearly always.
Eigen::Quaterniond turned_by(const Eigen::Vector3d& angle) {
  const double squared = angle.squaredNorm();
  if (squared < 0.01) {
    const double s = 0.5 - squared * (1.0 / 48 - squared / 3840);
    const double w = 1 - squared * (1.0 / 8 - squared / 384);
    return {w, s * angle.x(), s * angle.y(), s * angle.z()};
  }
  const double norm = std::sqrt(squared), s = std::sin(norm / 2) / norm;
  return {std::cos(norm / 2), s * angle.x(), s * angle.y(), s * angle.z()};
}

// One Newton step: the length is near 1 already.
void renormalise(Eigen::Quaterniond& q) { q.coeffs() *= 1.5 - 0.5 * q.squaredNorm(); }

// The shortest turn that lifts the unit vector `up` onto z.
Eigen::Quaterniond uprighting(const Eigen::Vector3d& up) {
  if (up.z() < -1 + 1e-9) return {0, 1, 0, 0};
  const double w = std::sqrt((1 + up.z()) / 2);
  return {w, up.y() / (2 * w), -up.x() / (2 * w), 0};
}

// Into ±π, from within ±3π.
double wrapped(double angle) {
  constexpr double pi = std::numbers::pi;
  return angle > pi ? angle - 2 * pi : angle < -pi ? angle + 2 * pi : angle;
}

double heading_of(const Eigen::Quaterniond& q) { return wrapped(2 * std::atan2(q.z(), q.w())); }

}  // namespace

bool plausible(const InertialReading& reading) {
  constexpr double most_radps = 75, most_mps2 = 1000;
  return reading.turn_rate_radps.squaredNorm() < most_radps * most_radps &&
         reading.specific_force_mps2.squaredNorm() < most_mps2 * most_mps2;
}

template <int Size>
void OrientationFilter::LowPass<Size>::add(const Eigen::Matrix<double, Size, 1>& input, double step_s,
                                           double time_s) {
  age += step_s;
  if (age < time_s) {
    value += (input - value) * (step_s / age);
    return;
  }
  const double w = std::numbers::sqrt2 / time_s;  // the step response then settles as fast as e^(-t/time)
  rate += ((input - value) * w - rate * std::numbers::sqrt2) * (w * step_s);
  value += rate * step_s;
}

OrientationFilter::OrientationFilter(const OrientationSettings& settings)
    : settings_(settings),
      bias_covariance_(Eigen::Matrix3d::Identity() * settings.start_bias_radps * settings.start_bias_radps) {}

void OrientationFilter::start(const Eigen::Vector3d& force) {
  started_ = true;
  force_ = {};
  turned_ = {};
  rest_turn_ = {};
  rest_force_ = {};
  drift_.setZero();
  drift_time_ = rest_time_ = sound_time_ = 0;
  inertial_from_sensor_.setIdentity();
  level_from_inertial_ = uprighting(force.normalized());
  level_from_sensor_ = level_from_inertial_;
}

bool OrientationFilter::add(const InertialReading& reading, double step_s) {
  const Eigen::Vector3d& force = reading.specific_force_mps2;
  if (!(step_s > 0) || !plausible(reading)) return false;
  if (!started_ || step_s > settings_.longest_step_s) {
    if (force.squaredNorm() < 1) return false;  // falling: there is no up
    const double before = heading_of(earth_from_sensor());
    const bool again = started_;
    start(force);
    if (again) heading_ = wrapped(before - heading_of(level_from_sensor_));
    step_s = std::min(step_s, 0.01);
  }
  watch_rest(reading, step_s);
  inertial_from_sensor_ = inertial_from_sensor_ * turned_by((reading.turn_rate_radps - bias_) * step_s);
  renormalise(inertial_from_sensor_);
  correct_inclination(force, step_s);
  learn_bias(step_s);
  heading_sigma_ = std::min(std::numbers::pi, heading_sigma_ + step_s * std::sqrt(bias_covariance_(2, 2)));
  if (reading.magnetic_field_ut && reading.magnetic_field_ut->allFinite())
    correct_heading(*reading.magnetic_field_ut, step_s);
  return true;
}

void OrientationFilter::correct_inclination(const Eigen::Vector3d& force, double step_s) {
  force_.add(inertial_from_sensor_ * force, step_s, settings_.force_time_s);
  const Eigen::Vector3d level = level_from_inertial_ * force_.value;
  const double norm = level.norm();
  if (norm > 1) {
    const Eigen::Quaterniond correction = uprighting(level / norm);
    level_from_inertial_ = correction * level_from_inertial_;
    renormalise(level_from_inertial_);
    drift_ += 2 * correction.vec().head<2>();
  }
  level_from_sensor_ = level_from_inertial_ * inertial_from_sensor_;
}

void OrientationFilter::watch_rest(const InertialReading& reading, double step_s) {
  rest_turn_.add(reading.turn_rate_radps, step_s, rest_time_constant_s);
  rest_force_.add(reading.specific_force_mps2, step_s, rest_time_constant_s);
  const bool quiet = (reading.turn_rate_radps - rest_turn_.value).squaredNorm() <
                         settings_.rest_turn_radps * settings_.rest_turn_radps &&
                     (reading.specific_force_mps2 - rest_force_.value).squaredNorm() <
                         settings_.rest_force_mps2 * settings_.rest_force_mps2 &&
                     rest_turn_.value.cwiseAbs().maxCoeff() < settings_.most_bias_radps;
  rest_time_ = quiet ? rest_time_ + step_s : 0;
}

// An offset of the gyroscope turns the inertial frame, and the inclination's correction keeps turning it
// back: lowpass(R bias) = lowpass(R bias as subtracted) − correction rate, in the two level directions.
void OrientationFilter::learn_bias(double step_s) {
  const Eigen::Matrix3d r = level_from_sensor_.toRotationMatrix();
  Eigen::Matrix<double, 8, 1> rows;
  rows << r.row(0).transpose(), r.row(1).transpose(), r.topRows<2>() * bias_;
  turned_.add(rows, step_s, settings_.force_time_s);
  drift_time_ += step_s;
  if (drift_time_ < bias_period_s) return;
  bias_covariance_.diagonal().array() += settings_.bias_walk * settings_.bias_walk * drift_time_;
  if (resting()) {
    const double noise = settings_.rest_bias_radps * settings_.rest_bias_radps / drift_time_;
    const Eigen::Matrix3d s = bias_covariance_ + Eigen::Matrix3d::Identity() * noise;
    const Eigen::Matrix3d gain = bias_covariance_ * s.inverse();
    bias_ += gain * (rest_turn_.value - bias_);
    bias_covariance_ -= gain * bias_covariance_.eval();
  } else if (force_.age > 2 * settings_.force_time_s) {
    Eigen::Matrix<double, 2, 3> h;
    h << turned_.value.head<3>().transpose(), turned_.value.segment<3>(3).transpose();
    const Eigen::Vector2d error = turned_.value.tail<2>() - drift_ / drift_time_ - h * bias_;
    const double noise = settings_.motion_bias_radps * settings_.motion_bias_radps / drift_time_;
    const Eigen::Matrix2d s = h * bias_covariance_ * h.transpose() + Eigen::Matrix2d::Identity() * noise;
    const Eigen::Matrix<double, 3, 2> gain = bias_covariance_ * h.transpose() * s.inverse();
    bias_ += gain * error;
    bias_covariance_ -= gain * h * bias_covariance_.eval();
  }
  bias_ = bias_.cwiseMax(-settings_.most_bias_radps).cwiseMin(settings_.most_bias_radps);
  drift_.setZero();
  drift_time_ = 0;
}

bool OrientationFilter::alike(const Field& a, const Field& b) const {
  const double across = a.dip.x() * b.dip.y() - a.dip.y() * b.dip.x();
  return std::abs(a.norm - b.norm) < settings_.field_norm_share * b.norm && a.dip.dot(b.dip) > 0 &&
         std::abs(across) < settings_.field_dip_rad;
}

void OrientationFilter::correct_heading(const Eigen::Vector3d& field, double step_s) {
  const double norm = field.norm();
  if (!(norm > 0)) return;
  const Eigen::Vector3d level = level_from_sensor_ * field;
  const Field seen{norm, {level.head<2>().norm() / norm, -level.z() / norm}};
  if (!has_field_ || force_.age < settings_.force_time_s) {
    // What is level is not yet known well enough to judge a field by.
    has_field_ = true;
    usual_ = seen;
    sound_time_ = settings_.field_settle_s;
    heading_age_ = std::min(heading_age_, provisional_heading_s);
  }
  // North lies at heading 0: the field's level part, turned by the heading, must point along y.
  double error = wrapped(std::atan2(level.x(), level.y()) - heading_);
  if (heading_age_ >= settings_.field_time_s)
    error = std::clamp(error, -settings_.field_turn_rad, settings_.field_turn_rad);
  if (alike(seen, usual_)) {
    const double share = std::min(1.0, step_s / field_memory_s);
    sound_time_ += step_s;
    other_time_ = 0;
    usual_.norm += share * (norm - usual_.norm);
    usual_.dip += share * (seen.dip - usual_.dip);
  } else {
    sound_time_ = 0;
    if (other_time_ == 0 || !alike(seen, other_)) {
      other_ = seen;
      other_time_ = 0;
    }
    if (!resting()) other_time_ += step_s;
    if (other_time_ > settings_.new_field_s) {
      usual_ = other_;
      heading_age_ = 0;
    }
  }
  if (sound_time_ < settings_.field_settle_s) return;
  heading_age_ = std::min(heading_age_ + step_s, settings_.field_time_s);
  const double gain = step_s / (heading_age_ + step_s);
  heading_ = wrapped(heading_ + (heading_known_ ? gain * error : error));
  heading_sigma_ =
      heading_known_ ? heading_sigma_ + gain * (usual_heading_rad - heading_sigma_) : first_heading_rad;
  heading_known_ = true;
}

Eigen::Quaterniond OrientationFilter::earth_from_sensor() const {
  const Eigen::Quaterniond turn(std::cos(heading_ / 2), 0, 0, std::sin(heading_ / 2));
  return turn * level_from_sensor_;
}

Eigen::Vector3d OrientationFilter::variance() const {
  const double settled = std::min(1.0, force_.age / settings_.force_time_s);
  const double inclination =
      first_inclination_rad + settled * (usual_inclination_rad - first_inclination_rad);
  return Eigen::Vector3d(inclination, inclination, heading_sigma_).cwiseAbs2();
}

void OrientationFilter::reverse() {
  bias_ = -bias_;
  force_.rate = -force_.rate;
  turned_.value.tail<2>() *= -1;
  turned_.rate.head<6>() *= -1;
  rest_turn_.value = -rest_turn_.value;
  rest_force_.rate = -rest_force_.rate;
  drift_.setZero();
  drift_time_ = 0;
}

void OrientationFilter::set_heading(const Eigen::Quaterniond& earth_from_sensor) {
  heading_ = heading_of((earth_from_sensor * level_from_sensor_.conjugate()).normalized());
  heading_known_ = true;
  heading_sigma_ = 0;
  heading_age_ = settings_.field_time_s;
}

}  // namespace fude
