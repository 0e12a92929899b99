#include "capture/picture/frame_encoding.h"

#include "capture/picture/picture_jpeg.h"
#include "capture/picture/picture_png.h"

namespace fude {
namespace {

Result<std::vector<std::byte>> as_png(std::span<const std::byte> picture, const CameraFrame& frame) {
  if (frame.format != PixelFormat::mjpeg) return raw_to_png(picture, frame.format, frame.width, frame.height);
  const auto pixels = jpeg_to_rgb(picture, frame.width, frame.height);
  if (!pixels) return tl::unexpected(pixels.error());
  return rgb_to_png(*pixels, frame.width, frame.height);
}

}  // namespace

Result<std::vector<std::byte>> encoded(std::span<const std::byte> picture, CameraFrame& frame,
                                       FrameEncoding wish) {
  const PixelFormat becomes = wish == FrameEncoding::png    ? PixelFormat::png
                              : wish == FrameEncoding::jpeg ? PixelFormat::mjpeg
                                                            : frame.format;
  if (frame.format == becomes) return std::vector(picture.begin(), picture.end());
  if (frame.format == PixelFormat::png)
    return failure(Fault::unsupported, "a PNG is not made a JPEG; it stays as it is");
  auto bytes = becomes == PixelFormat::png ? as_png(picture, frame)
                                           : raw_to_jpeg(picture, frame.format, frame.width, frame.height);
  if (bytes) frame.format = becomes;
  return bytes;
}

}  // namespace fude
