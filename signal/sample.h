// Whatever a driver made of the bytes.
#pragma once

#include <variant>

#include "signal/camera_frame.h"
#include "signal/glove_sample.h"
#include "signal/haptic_sample.h"
#include "signal/imu_sample.h"
#include "signal/pen_sample.h"
#include "signal/pose_sample.h"
#include "signal/position_sample.h"
#include "signal/puck_sample.h"
#include "signal/range_sample.h"
#include "signal/tick_sample.h"
#include "signal/touch_sample.h"

namespace fude {

using Sample = std::variant<PenSample, TouchSample, ImuSample, PoseSample, PositionSample, RangeSample,
                            PuckSample, GloveSample, HapticSample, CameraFrame, TickSample>;

}  // namespace fude
