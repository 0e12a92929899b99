// What a camera was asked for and what it made of it, for people and for the session.
#pragma once

#include <string>

#include "drivers/transport/v4l2_source.h"

namespace fude {

// What became otherwise, in one line: "asked for 1280 x 720, gives 640 x 480; asked for focus 3, has none".
// Empty where the camera does as asked: a rate within 1 %, an exposure within half its step of 0.1 ms.
std::string camera_remark(const CameraSettings& asked, const CameraSettings& given);

// As JSON: format, width, height, rate_hz (null where the camera does not say), exposure_s, gain and focus
// (in the camera's own units; null where they are not held).
std::string camera_record(const CameraSettings& given);

}  // namespace fude
