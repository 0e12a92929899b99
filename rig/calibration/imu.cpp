#include "rig/calibration/imu.h"

#include "calibration/imu.h"
#include "rig/calibration/stream_calibrator.h"

namespace fude {

std::unique_ptr<Calibrator> imu_calibrator(const ImuWish& wish) {
  return std::make_unique<StreamCalibrator<ImuSample, ImuProcedure>>(wish.unit, "inertial unit",
                                                                     ImuProcedure());
}

}  // namespace fude
