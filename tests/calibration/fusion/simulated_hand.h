// A hand that writes, in closed form, and what sensors on its brush would read: the truth and its noise are
// both known.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "calibration/fusion/fusion.h"

namespace fude {

inline Timestamp at_second(double t) {
  return Timestamp(Duration(static_cast<Duration::rep>(std::llround(t * 1e9))));
}

struct SimulatedHand {
  double size_m = 0.06;  // of its strokes
  double speed = 1;      // 1: about 0.4 m/s at most
  double lean_rad = 0.5;
  Eigen::Vector3d gyro_bias_radps{0.004, -0.003, 0.002};
  Eigen::Vector3d accel_bias_mps2{0.03, -0.02, 0.04};
  Eigen::Vector3d gravity_mps2{0, 0, -9.81};
  Eigen::Vector3d field_ut{0, 18, -40};

  Eigen::Vector3d position(double t) const {
    const double s = speed * t;
    return {0.1 + size_m * std::sin(5 * s), 0.2 + size_m * std::cos(4 * s + 0.3),
            0.2 + 0.3 * size_m * std::sin(7 * s)};
  }
  Eigen::Vector3d velocity(double t) const {
    const double s = speed * t;
    return speed * size_m *
           Eigen::Vector3d(5 * std::cos(5 * s), -4 * std::sin(4 * s + 0.3), 2.1 * std::cos(7 * s));
  }
  Eigen::Quaterniond rotation(double t) const {
    const double s = speed * t;
    return rotation_of({lean_rad * std::sin(2 * s), lean_rad * std::cos(1.7 * s), 0}) *
           rotation_of({0, 0, 0.8 * std::sin(1.1 * s)});
  }

  // Without noise: the mean over the step that ends at t, as an inertial unit gives it.
  InertialReading reading(double t, double step_s) const {
    InertialReading r;
    r.turn_rate_radps = turn_of(rotation(t - step_s).conjugate() * rotation(t)) / step_s + gyro_bias_radps;
    const Eigen::Quaterniond middle = rotation(t - step_s / 2);
    r.specific_force_mps2 =
        middle.conjugate() * ((velocity(t) - velocity(t - step_s)) / step_s - gravity_mps2) + accel_bias_mps2;
    r.magnetic_field_ut = rotation(t).conjugate() * field_ut;
    return r;
  }
};

// White noise of stated densities.
struct SimulatedNoise {
  explicit SimulatedNoise(unsigned seed) : generator(seed) {}
  std::mt19937 generator;
  std::normal_distribution<double> normal{0, 1};

  Eigen::Vector3d vector(double sigma) {
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return sigma * Eigen::Vector3d(x, y, z);
  }
  InertialReading onto(InertialReading r, double step_s, const MotionNoise& noise) {
    r.turn_rate_radps += vector(noise.gyro_radps / std::sqrt(step_s));
    r.specific_force_mps2 += vector(noise.accel_mps2 / std::sqrt(step_s));
    if (r.magnetic_field_ut) *r.magnetic_field_ut += vector(0.3);
    return r;
  }
};

}  // namespace fude
