#include "rig/calibration/common_motion.h"

#include "calibration/common_motion.h"
#include "rig/calibration/two_tools.h"

namespace fude {

std::unique_ptr<Calibrator> common_motion_calibrator(const CommonMotionWish& wish) {
  return std::make_unique<TwoToolCalibrator<CommonMotionProcedure>>(TwoTools(wish.tool, wish.other),
                                                                    &TwoTools::sign);
}

}  // namespace fude
