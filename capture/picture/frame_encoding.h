// In what form a recording keeps a camera's pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "signal/camera_frame.h"
#include "signal/result.h"

namespace fude {

enum class FrameEncoding : std::uint8_t { as_sent, png, jpeg };

// `picture`, which `frame` describes, in the form wished for; `frame.format` is changed to what it then is.
// png loses nothing of grey and yuyv (picture_png.h) and holds the pixels of an mjpeg; jpeg leaves an mjpeg
// as it is. Errors, with `frame` as it was: malformed where the bytes are not what `frame` says, or damaged;
// unsupported where there is no such way.
Result<std::vector<std::byte>> encoded(std::span<const std::byte> picture, CameraFrame& frame,
                                       FrameEncoding wish);

}  // namespace fude
