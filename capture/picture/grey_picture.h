// What a recorded picture shows, in shades of grey, whatever it was kept as.
#pragma once

#include <cstddef>
#include <span>

#include "signal/camera_frame.h"
#include "signal/grey_image.h"
#include "signal/result.h"

namespace fude {

// Luminance, as the camera sent it; of colours in a PNG, that of sRGB. `picture` may be any bytes. Errors:
// malformed where they are not what `frame` says, or damaged.
Result<GreyImage> grey_picture(std::span<const std::byte> picture, const CameraFrame& frame);

}  // namespace fude
