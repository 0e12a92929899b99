#include "capture/picture/grey_picture.h"

#include <png.h>

#include <string>
#include <utility>
#include <vector>

#include "capture/picture/picture_jpeg.h"
#include "capture/picture/picture_png.h"

namespace fude {
namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 27;  // a head may say anything

GreyImage image_of(std::span<const std::byte> luminance, const CameraFrame& frame) {
  GreyImage image{frame.width, frame.height, {}};
  const auto* first = reinterpret_cast<const std::uint8_t*>(luminance.data());
  image.pixels.assign(first, first + luminance.size());
  return image;
}

Result<GreyImage> of_other_size(const CameraFrame& frame) {
  return failure(Fault::malformed, "a picture is not of the " + std::to_string(frame.width) + " x " +
                                       std::to_string(frame.height) + " pixels that it is said to have");
}

Result<GreyImage> of_raw(std::span<const std::byte> picture, PixelFormat format, const CameraFrame& frame) {
  const std::size_t pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const std::size_t bytes = format == PixelFormat::yuyv ? 2 : 1;
  if (frame.width < 1 || frame.height < 1 || picture.size() != bytes * pixels) return of_other_size(frame);
  if (bytes == 1) return image_of(picture, frame);
  std::vector<std::byte> luminance;
  for (std::size_t at = 0; at < picture.size(); at += bytes) luminance.push_back(picture[at]);
  return image_of(luminance, frame);
}

// A PNG from elsewhere: colours, any depth.
Result<GreyImage> of_any_png(std::span<const std::byte> png, const CameraFrame& frame) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&head, png.data(), png.size()))
    return failure(Fault::malformed, std::string("this is no PNG, or a damaged one: ") + head.message);
  // Before any memory is taken for it.
  if (head.width != static_cast<png_uint_32>(frame.width) ||
      head.height != static_cast<png_uint_32>(frame.height)) {
    png_image_free(&head);
    return of_other_size(frame);
  }
  head.format = PNG_FORMAT_GRAY;
  std::vector<std::byte> luminance(PNG_IMAGE_SIZE(head));
  const png_color on_white{255, 255, 255};  // where the picture is transparent
  if (!png_image_finish_read(&head, &on_white, luminance.data(), 0, nullptr))
    return failure(Fault::malformed, std::string("this PNG is damaged: ") + head.message);
  return image_of(luminance, frame);
}

Result<GreyImage> of_png(std::span<const std::byte> png, const CameraFrame& frame) {
  const auto raw = raw_from_png(png);
  if (!raw && raw.error().fault == Fault::unsupported) return of_any_png(png, frame);
  if (!raw) return tl::unexpected(raw.error());
  if (raw->width != frame.width || raw->height != frame.height) return of_other_size(frame);
  return of_raw(raw->bytes, raw->format, frame);
}

}  // namespace

Result<GreyImage> grey_picture(std::span<const std::byte> picture, const CameraFrame& frame) {
  if (std::int64_t{frame.width} * frame.height > most_pixels)
    return failure(Fault::malformed, "a picture of " + std::to_string(frame.width) + " x " +
                                         std::to_string(frame.height) + " pixels is no camera's");
  switch (frame.format) {
    case PixelFormat::grey:
    case PixelFormat::yuyv:
      return of_raw(picture, frame.format, frame);
    case PixelFormat::png:
      return of_png(picture, frame);
    case PixelFormat::mjpeg:
      break;
  }
  const auto luminance = jpeg_to_grey(picture, frame.width, frame.height);
  if (!luminance) return tl::unexpected(luminance.error());
  return image_of(*luminance, frame);
}

}  // namespace fude
