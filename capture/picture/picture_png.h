// A camera's pictures as PNG, and its very bytes back again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signal/camera_frame.h"
#include "signal/result.h"

namespace fude {

// The bytes of a row stand in the PNG as the camera sent them: grey as 8-bit grey; yuyv as 8-bit grey with
// alpha, the grey being luminance and the alpha U and V in turn. Errors: malformed where `picture` has not
// the size of that format; unsupported for another format.
Result<std::vector<std::byte>> raw_to_png(std::span<const std::byte> picture, PixelFormat format,
                                          std::int32_t width, std::int32_t height);

// `pixels`: three bytes each, row by row from the top. Errors: malformed where it has not that size.
Result<std::vector<std::byte>> rgb_to_png(std::span<const std::byte> pixels, std::int32_t width,
                                          std::int32_t height);

struct RawPicture {
  PixelFormat format = PixelFormat::grey;  // or yuyv
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<std::byte> bytes;  // as the camera sent them
};

// What raw_to_png() was given. Errors: malformed for what is no PNG, or a damaged one; unsupported for one
// that holds no camera's bytes (colours, another depth, interlaced, more than 65535 pixels a side).
Result<RawPicture> raw_from_png(std::span<const std::byte> png);

}  // namespace fude
