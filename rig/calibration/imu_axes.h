// How an inertial unit's axes lie to a tool's markers, from a session in which both turned
// (calibration/sensor_axes.h).
#pragma once

#include <memory>
#include <string>

#include "rig/calibration/calibrator.h"

namespace fude {

struct ImuAxesWish {
  std::string tool;  // empty: the only one
  std::string unit;  // empty: the only one
};

std::unique_ptr<Calibrator> imu_axes_calibrator(const ImuAxesWish& wish);

}  // namespace fude
