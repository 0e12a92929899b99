// One reading of an inertial unit, in its own frame as its maker draws it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "signal/timestamp.h"
#include "signal/units.h"

namespace fude {

// Factory calibration is applied where the device holds one; ours is not.
struct ImuSample {
  SampleTime time;
  Eigen::Vector3d turn_rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();  // +9.81 upward at rest
  std::optional<Eigen::Vector3d> magnetic_field_ut;
  std::optional<double> temperature_c;
  std::optional<Fraction> battery;  // of its charge
  std::uint32_t buttons = 0;
  bool saturated = false;  // some axis stood at the end of its range
  bool valid = true;       // false: the device or the file says that it could not measure
  bool after_gap = false;
  bool operator==(const ImuSample&) const = default;
};

}  // namespace fude
