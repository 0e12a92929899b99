// Where an ultrasonic emitter is, from the times that its pulse took to receivers at known places.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "signal/position_sample.h"
#include "signal/range_sample.h"
#include "signal/result.h"

namespace fude::ultrasonic {

// Of dry air, m/s, for -50 to 60 °C (Cramer 1993 differs by less than 0.2 % at 50 % humidity).
double speed_of_sound_mps(double temperature_c);

struct Receivers {
  std::span<const Eigen::Vector3d> positions_m;  // in the board's order, in the tracker's frame
  double range_sigma_m = 0.0005;                 // expected of one range
  double usual_temperature_c = 20;               // where the board has no thermometer
};

struct Fix {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  // (JᵀJ)⁻¹ s²: the geometry by the spread s², in which the residuals and the expected sigma are weighed
  // as so many measurements each (four for the expected one).
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double residual_m = 0;        // root mean square over the receivers used
  std::uint32_t receivers = 0;  // bit i: receiver i was used
};

// Least squares of range residuals by damped Gauss-Newton steps. An echo is longer than the straight way:
// while five or more receivers agree badly (a residual beyond five sigma) the one is left out without
// which the rest agree best, if its own way is then too long. Receivers in one plane see the same on
// both its sides: the side of `near` is taken, without it the one where z is greater. Errors, malformed:
// fewer than three heard it, they stand in one line, the emitter lies in their plane, or the ranges
// contradict each other.
Result<Fix> multilaterate(const RangeSample& ranges, const Receivers& receivers,
                          const std::optional<Eigen::Vector3d>& near = std::nullopt);

// The same as a sample, not valid where there is no fix.
PositionSample position_of(const RangeSample& ranges, const Receivers& receivers,
                           const std::optional<Eigen::Vector3d>& near = std::nullopt);

}  // namespace fude::ultrasonic
