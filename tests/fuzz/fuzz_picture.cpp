// A camera's pictures in every form that a recording may keep them, and a stranger's PNG.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "capture/picture/frame_encoding.h"
#include "capture/picture/grey_picture.h"
#include "capture/picture/picture_png.h"

using namespace fude;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  if (const auto raw = raw_from_png(bytes)) {
    const auto again = raw_to_png(raw->bytes, raw->format, raw->width, raw->height);
    if (!again || raw_from_png(*again)->bytes != raw->bytes) std::abort();
  }
  if (size < 3) return 0;
  CameraFrame frame;
  frame.format = static_cast<PixelFormat>(data[0] % 4);
  frame.width = data[1];
  frame.height = data[2];
  for (const FrameEncoding wish : {FrameEncoding::png, FrameEncoding::jpeg}) {
    CameraFrame kept = frame;
    (void)encoded(bytes.subspan(3), kept, wish);
  }
  if (const auto grey = grey_picture(bytes.subspan(3), frame);
      grey && grey->pixels.size() != std::size_t{data[1]} * data[2])
    std::abort();
  return 0;
}
