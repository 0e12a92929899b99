// Where one tracker stands to another, from a session in which both saw the same motion
// (calibration/common_motion.h).
#pragma once

#include <memory>
#include <string>

#include "rig/calibration/calibrator.h"

namespace fude {

struct CommonMotionWish {
  std::string tool;   // empty: the only one beside `other`
  std::string other;  // what the other tracker sees
};

std::unique_ptr<Calibrator> common_motion_calibrator(const CommonMotionWish& wish);

}  // namespace fude
