// A camera's pictures as JPEG, and its motion JPEG as pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signal/camera_frame.h"
#include "signal/result.h"

namespace fude {

// Three bytes a pixel, row by row from the top. The bytes may be anything, and may lack the standard Huffman
// tables, as motion JPEG does. Errors: malformed for what is no JPEG, a damaged one, or one of another size.
Result<std::vector<std::byte>> jpeg_to_rgb(std::span<const std::byte> jpeg, std::int32_t width,
                                           std::int32_t height);

// The same as luminance, one byte a pixel.
Result<std::vector<std::byte>> jpeg_to_grey(std::span<const std::byte> jpeg, std::int32_t width,
                                            std::int32_t height);

// Grey, or yuyv of limited range (ITU-R BT.601, as V4L2 has it), scaled to the full range that a JPEG has;
// its colours keep their resolution (4:2:2). Errors: malformed where `picture` has not the size of that
// format; unsupported for another format.
Result<std::vector<std::byte>> raw_to_jpeg(std::span<const std::byte> picture, PixelFormat format,
                                           std::int32_t width, std::int32_t height);

}  // namespace fude
