#include "capture/picture/picture_jpeg.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace fude {
namespace {

constexpr int quality = 92;
constexpr std::int32_t largest_side = 65500;  // libjpeg's

struct Close {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Close>;

struct Free {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

Error size_error(std::size_t bytes, std::int32_t width, std::int32_t height) {
  return {Fault::malformed, "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                " has not " + std::to_string(bytes) + " bytes"};
}

Error no_memory() { return {Fault::storage, "no memory for a picture's JPEG; record smaller pictures"}; }

// Black and white of BT.601 lie at 16 and 235, colours within 112 of 128.
unsigned char full_luminance(std::byte value) {
  return static_cast<unsigned char>(
      std::clamp((std::to_integer<int>(value) * 255 - 16 * 255 + 109) / 219, 0, 255));
}
unsigned char full_colour(std::byte value) {
  const int distance = (std::to_integer<int>(value) - 128) * 255;
  return static_cast<unsigned char>(std::clamp(128 + (distance + (distance < 0 ? -112 : 112)) / 224, 0, 255));
}

struct Planes {
  std::vector<unsigned char> y, u, v;
};

// In a row of odd width the last pair has no second luminance, and so no V; TurboJPEG takes whole pairs.
Planes planes_of_yuyv(std::span<const std::byte> picture, std::size_t width, std::size_t height) {
  const std::size_t pairs = (width + 1) / 2;
  Planes planes{std::vector<unsigned char>(2 * pairs * height),
                std::vector<unsigned char>(pairs * height, 128),
                std::vector<unsigned char>(pairs * height, 128)};
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t x = 0; x < width; ++x) {
      const std::byte* pixel = &picture[2 * (row * width + x)];
      planes.y[2 * row * pairs + x] = full_luminance(pixel[0]);
      if (x == width - 1 && x % 2 == 0) planes.y[2 * row * pairs + x + 1] = full_luminance(pixel[0]);
      (x % 2 == 0 ? planes.u : planes.v)[row * pairs + x / 2] = full_colour(pixel[1]);
    }
  return planes;
}

Result<std::vector<std::byte>> decompressed(std::span<const std::byte> jpeg, std::int32_t width,
                                            std::int32_t height, TJPF form) {
  const Handle handle(tjInitDecompress());
  if (!handle) return tl::unexpected(no_memory());
  const auto* bytes = reinterpret_cast<const unsigned char*>(jpeg.data());
  int columns = 0, rows = 0, sampling = 0, colours = 0;
  if (tjDecompressHeader3(handle.get(), bytes, jpeg.size(), &columns, &rows, &sampling, &colours) != 0)
    return failure(Fault::malformed, "this is no JPEG, or a damaged one");
  // Before any memory is taken for it.
  if (columns != width || rows != height)
    return failure(Fault::malformed, "a JPEG of " + std::to_string(columns) + " x " + std::to_string(rows) +
                                         " came where one of " + std::to_string(width) + " x " +
                                         std::to_string(height) + " was due");
  std::vector<std::byte> pixels(static_cast<std::size_t>(tjPixelSize[form]) *
                                static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  // A warning is a picture with a hole in it.
  if (tjDecompress2(handle.get(), bytes, jpeg.size(), reinterpret_cast<unsigned char*>(pixels.data()),
                    columns, 0, rows, form,
                    TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
    return failure(Fault::malformed, "this JPEG is damaged");
  return pixels;
}

}  // namespace

Result<std::vector<std::byte>> jpeg_to_rgb(std::span<const std::byte> jpeg, std::int32_t width,
                                           std::int32_t height) {
  return decompressed(jpeg, width, height, TJPF_RGB);
}

Result<std::vector<std::byte>> jpeg_to_grey(std::span<const std::byte> jpeg, std::int32_t width,
                                            std::int32_t height) {
  return decompressed(jpeg, width, height, TJPF_GRAY);
}

Result<std::vector<std::byte>> raw_to_jpeg(std::span<const std::byte> picture, PixelFormat format,
                                           std::int32_t width, std::int32_t height) {
  if (format != PixelFormat::grey && format != PixelFormat::yuyv)
    return failure(Fault::unsupported, "only GREY and YUYV pictures are made JPEG");
  const bool grey = format == PixelFormat::grey;
  if (width < 1 || height < 1 || width > largest_side || height > largest_side)
    return tl::unexpected(size_error(picture.size(), width, height));
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  if (picture.size() != columns * rows * (grey ? 1 : 2))
    return tl::unexpected(size_error(picture.size(), width, height));

  const Handle handle(tjInitCompress());
  if (!handle) return tl::unexpected(no_memory());
  const int sampling = grey ? TJSAMP_GRAY : TJSAMP_422;
  Planes planes;
  std::array<const unsigned char*, 3> starts{reinterpret_cast<const unsigned char*>(picture.data()), nullptr,
                                             nullptr};
  const int pairs = (width + 1) / 2;
  const std::array<int, 3> strides{grey ? width : 2 * pairs, pairs, pairs};
  if (!grey) {
    planes = planes_of_yuyv(picture, columns, rows);
    starts = {planes.y.data(), planes.u.data(), planes.v.data()};
  }
  unsigned char* made = nullptr;
  unsigned long size = 0;
  const int status = tjCompressFromYUVPlanes(handle.get(), starts.data(), width, strides.data(), height,
                                             sampling, &made, &size, quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, Free> owned(made);
  if (status != 0) return tl::unexpected(no_memory());
  const auto* begin = reinterpret_cast<const std::byte*>(made);
  return std::vector(begin, begin + size);
}

}  // namespace fude
