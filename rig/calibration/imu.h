// What an inertial unit's readings lack, from a session in which it is laid on its sides and tumbled
// (calibration/imu.h).
#pragma once

#include <memory>
#include <string>

#include "rig/calibration/calibrator.h"

namespace fude {

struct ImuWish {
  std::string unit;  // empty: the only one
};

std::unique_ptr<Calibrator> imu_calibrator(const ImuWish& wish);

}  // namespace fude
