// Pictures as recordings keep them: nothing lost where nothing may be, and damaged ones refused.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <random>
#include <vector>

#include "capture/picture/frame_encoding.h"
#include "capture/picture/grey_picture.h"
#include "capture/picture/picture_jpeg.h"
#include "capture/picture/picture_png.h"

namespace fude {
namespace {

using Bytes = std::vector<std::byte>;

struct Size {
  std::int32_t width, height;
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};
constexpr Size sizes[] = {{1, 1}, {2, 2}, {3, 5}, {7, 1}, {1, 9}, {16, 16}, {641, 3}, {130, 33}};

Bytes noise(std::size_t count) {
  std::mt19937 random(7);
  Bytes bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

// By libpng's own reading of a whole picture, which takes none of our ways.
Bytes read_by_libpng(const Bytes& png, png_uint_32 format, Size size) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&image, png.data(), png.size()));
  EXPECT_EQ(image.format, format);
  EXPECT_EQ(image.width, static_cast<png_uint_32>(size.width));
  EXPECT_EQ(image.height, static_cast<png_uint_32>(size.height));
  image.format = format;
  Bytes bytes(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr));
  return bytes;
}

CameraFrame frame_of(PixelFormat format, Size size) {
  CameraFrame frame;
  frame.format = format;
  frame.width = size.width;
  frame.height = size.height;
  return frame;
}

// Lies smoothly between black and white of limited range, its colours between pale ones.
Bytes smooth_yuyv(Size size) {
  Bytes bytes;
  for (std::int32_t y = 0; y < size.height; ++y)
    for (std::int32_t x = 0; x < size.width; ++x) {
      bytes.push_back(static_cast<std::byte>(60 + 100 * x / size.width));
      bytes.push_back(static_cast<std::byte>((x % 2 == 0 ? 120 : 130) + 10 * y / size.height));
    }
  return bytes;
}

Bytes jpeg_of(Size size) {
  return raw_to_jpeg(smooth_yuyv(size), PixelFormat::yuyv, size.width, size.height).value();
}

TEST(PicturePng, EveryByteOfTheCameraComesBack) {
  for (const Size size : sizes)
    for (const PixelFormat format : {PixelFormat::grey, PixelFormat::yuyv}) {
      const bool grey = format == PixelFormat::grey;
      const Bytes sent = noise(size.pixels() * (grey ? 1 : 2));
      const auto png = raw_to_png(sent, format, size.width, size.height);
      ASSERT_TRUE(png) << png.error().message;
      EXPECT_EQ(read_by_libpng(*png, grey ? PNG_FORMAT_GRAY : PNG_FORMAT_GA, size), sent);
      const auto back = raw_from_png(*png);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->format, format);
      EXPECT_EQ(back->width, size.width);
      EXPECT_EQ(back->height, size.height);
      EXPECT_EQ(back->bytes, sent);
    }
}

// Of several chunks, when it is nothing but noise; of a sensor's noise in the time printed.
TEST(PicturePng, AsLargeAsCamerasSendThem) {
  constexpr Size size{1280, 720};
  const Bytes nothing_but_noise = noise(2 * size.pixels());
  EXPECT_EQ(
      raw_from_png(raw_to_png(nothing_but_noise, PixelFormat::yuyv, size.width, size.height).value())->bytes,
      nothing_but_noise);
  std::mt19937 random(8);
  std::normal_distribution<double> sensor(0, 3);
  Bytes sent = smooth_yuyv(size);
  for (std::byte& byte : sent)
    byte = static_cast<std::byte>(std::clamp(std::to_integer<int>(byte) + sensor(random), 0.0, 255.0));
  double fastest_ms = 1e9;
  Bytes png;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t begin = std::clock();
    png = raw_to_png(sent, PixelFormat::yuyv, size.width, size.height).value();
    fastest_ms = std::min(fastest_ms, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  EXPECT_EQ(raw_from_png(png)->bytes, sent);
  std::printf(
      "figure: 1280 x 720 yuyv with noise of 3 counts as PNG: %.1f ms of a processor, %zu of %zu bytes\n",
      fastest_ms, png.size(), sent.size());
  EXPECT_LT(png.size(), sent.size() * 2 / 3);
}

TEST(PicturePng, WhatIsNotThePictureItSaysIsRefused) {
  EXPECT_EQ(raw_to_png(noise(11), PixelFormat::grey, 3, 4).error().fault, Fault::malformed);
  EXPECT_EQ(raw_to_png(noise(12), PixelFormat::yuyv, 3, 4).error().fault, Fault::malformed);
  EXPECT_EQ(raw_to_png({}, PixelFormat::grey, 0, 4).error().fault, Fault::malformed);
  EXPECT_EQ(raw_to_png({}, PixelFormat::grey, -1, -1).error().fault, Fault::malformed);
  EXPECT_EQ(raw_to_png(noise(12), PixelFormat::mjpeg, 3, 4).error().fault, Fault::unsupported);
}

TEST(PicturePng, CutOrChangedAnywhereItIsRefused) {
  const Bytes png = raw_to_png(noise(24), PixelFormat::yuyv, 4, 3).value();
  for (std::size_t kept = 0; kept < png.size(); ++kept)
    EXPECT_FALSE(raw_from_png(std::span(png).first(kept))) << kept;
  for (std::size_t at = 0; at < png.size(); ++at) {
    Bytes changed = png;
    changed[at] ^= std::byte{0x10};
    EXPECT_FALSE(raw_from_png(changed)) << at;
  }
}

TEST(PicturePng, ColoursAreNoCamerasBytes) {
  const Bytes pixels = noise(36);
  const Bytes png = rgb_to_png(pixels, 4, 3).value();
  EXPECT_EQ(read_by_libpng(png, PNG_FORMAT_RGB, {4, 3}), pixels);
  EXPECT_EQ(raw_from_png(png).error().fault, Fault::unsupported);
}

// Against BT.601 in real numbers; what is left is the JPEG's own loss.
TEST(PictureJpeg, AYuyvPictureHasItsColours) {
  for (const Size size : sizes) {
    const Bytes sent = smooth_yuyv(size);
    const auto pixels = jpeg_to_rgb(jpeg_of(size), size.width, size.height);
    ASSERT_TRUE(pixels) << pixels.error().message;
    ASSERT_EQ(pixels->size(), 3 * size.pixels());
    const auto row = static_cast<std::size_t>(size.width);
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      const std::size_t even = i - i % row % 2;
      const bool lone = i % row == row - 1 && i == even;  // without a V
      const double y = (std::to_integer<int>(sent[2 * i]) - 16) / 219.0;
      const double u = (std::to_integer<int>(sent[2 * even + 1]) - 128) / 224.0;
      const double v = lone ? 0 : (std::to_integer<int>(sent[2 * even + 3]) - 128) / 224.0;
      const double rgb[] = {y + 1.402 * v, y - 0.344136 * u - 0.714136 * v, y + 1.772 * u};
      // Beside a lone pixel its neighbours' V is smoothed towards none.
      const double tolerance = row % 2 == 1 && i % row + 3 >= row ? 16 : 7;
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(std::to_integer<int>((*pixels)[3 * i + c]), 255 * rgb[c], tolerance)
            << size.width << " x " << size.height << " pixel " << i;
    }
  }
}

TEST(PictureJpeg, AGreyPictureStaysGrey) {
  constexpr Size size{45, 17};
  Bytes sent;
  for (std::size_t i = 0; i < size.pixels(); ++i) sent.push_back(static_cast<std::byte>(i % 45 * 5));
  const auto jpeg = raw_to_jpeg(sent, PixelFormat::grey, size.width, size.height);
  ASSERT_TRUE(jpeg);
  const auto pixels = jpeg_to_rgb(*jpeg, size.width, size.height);
  ASSERT_TRUE(pixels);
  for (std::size_t i = 0; i < 3 * size.pixels(); ++i)
    EXPECT_NEAR(std::to_integer<int>((*pixels)[i]), std::to_integer<int>(sent[i / 3]), 4);
}

TEST(PictureJpeg, WhatIsNotThePictureItSaysIsRefused) {
  EXPECT_EQ(raw_to_jpeg(noise(13), PixelFormat::grey, 3, 4).error().fault, Fault::malformed);
  EXPECT_EQ(raw_to_jpeg({}, PixelFormat::yuyv, 0, 0).error().fault, Fault::malformed);
  EXPECT_EQ(raw_to_jpeg(noise(12), PixelFormat::png, 3, 4).error().fault, Fault::unsupported);
  const Bytes jpeg = jpeg_of({32, 16});
  EXPECT_EQ(jpeg_to_rgb(jpeg, 32, 17).error().fault, Fault::malformed);
  EXPECT_EQ(jpeg_to_rgb(noise(400), 32, 16).error().fault, Fault::malformed);
  EXPECT_EQ(jpeg_to_rgb({}, 32, 16).error().fault, Fault::malformed);
}

TEST(PictureJpeg, CutAnywhereItIsRefusedAndChangedAnywhereHarmless) {
  const Bytes jpeg = jpeg_of({32, 16});
  for (std::size_t kept = 0; kept < jpeg.size(); ++kept)
    EXPECT_FALSE(jpeg_to_rgb(std::span(jpeg).first(kept), 32, 16)) << kept;
  for (std::size_t at = 0; at < jpeg.size(); ++at)
    for (const auto flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xff}}) {
      Bytes changed = jpeg;
      changed[at] ^= flip;
      if (const auto pixels = jpeg_to_rgb(changed, 32, 16)) {
        EXPECT_EQ(pixels->size(), 3u * 32 * 16);
      }
    }
}

// As motion JPEG comes from many cameras.
TEST(PictureJpeg, WithoutHuffmanTablesTheStandardOnesAreMeant) {
  const Bytes jpeg = jpeg_of({32, 16});
  Bytes bare(jpeg.begin(), jpeg.begin() + 2);
  std::size_t tables = 0;
  for (std::size_t at = 2; jpeg[at + 1] != std::byte{0xda};) {
    const std::size_t length =
        2 + std::to_integer<std::size_t>(jpeg[at + 2]) * 256 + std::to_integer<std::size_t>(jpeg[at + 3]);
    const auto segment = std::span(jpeg).subspan(at, length);
    const bool huffman = jpeg[at + 1] == std::byte{0xc4};
    if (!huffman) bare.insert(bare.end(), segment.begin(), segment.end());
    tables += huffman;
    at += length;
    if (jpeg[at + 1] == std::byte{0xda})
      bare.insert(bare.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  }
  ASSERT_GT(tables, 0u);
  EXPECT_EQ(jpeg_to_rgb(bare, 32, 16).value(), jpeg_to_rgb(jpeg, 32, 16).value());
}

TEST(FrameEncoding, EachFormatInEachFormWishedFor) {
  constexpr Size size{33, 7};
  const Bytes jpeg = jpeg_of(size);
  struct Case {
    PixelFormat sent;
    FrameEncoding wish;
    PixelFormat becomes;
  };
  for (const Case& c : {Case{PixelFormat::grey, FrameEncoding::as_sent, PixelFormat::grey},
                        Case{PixelFormat::yuyv, FrameEncoding::as_sent, PixelFormat::yuyv},
                        Case{PixelFormat::mjpeg, FrameEncoding::as_sent, PixelFormat::mjpeg},
                        Case{PixelFormat::grey, FrameEncoding::png, PixelFormat::png},
                        Case{PixelFormat::yuyv, FrameEncoding::png, PixelFormat::png},
                        Case{PixelFormat::mjpeg, FrameEncoding::png, PixelFormat::png},
                        Case{PixelFormat::grey, FrameEncoding::jpeg, PixelFormat::mjpeg},
                        Case{PixelFormat::yuyv, FrameEncoding::jpeg, PixelFormat::mjpeg},
                        Case{PixelFormat::mjpeg, FrameEncoding::jpeg, PixelFormat::mjpeg}}) {
    const Bytes sent = c.sent == PixelFormat::mjpeg  ? jpeg
                       : c.sent == PixelFormat::yuyv ? smooth_yuyv(size)
                                                     : noise(size.pixels());
    CameraFrame frame = frame_of(c.sent, size);
    const auto kept = encoded(sent, frame, c.wish);
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_EQ(frame, frame_of(c.becomes, size));
    if (c.sent == c.becomes) {
      EXPECT_EQ(*kept, sent);
    } else if (c.becomes == PixelFormat::mjpeg) {
      EXPECT_TRUE(jpeg_to_rgb(*kept, size.width, size.height));
    } else if (c.sent == PixelFormat::mjpeg) {
      EXPECT_EQ(read_by_libpng(*kept, PNG_FORMAT_RGB, size),
                jpeg_to_rgb(sent, size.width, size.height).value());
    } else {
      EXPECT_EQ(raw_from_png(*kept).value().bytes, sent);
    }
  }
}

TEST(FrameEncoding, ADamagedPictureIsRefusedAndItsFrameStaysAsItWas) {
  Bytes jpeg = jpeg_of({32, 16});
  jpeg.resize(jpeg.size() / 2);
  CameraFrame frame = frame_of(PixelFormat::mjpeg, {32, 16});
  EXPECT_EQ(encoded(jpeg, frame, FrameEncoding::png).error().fault, Fault::malformed);
  EXPECT_EQ(frame, frame_of(PixelFormat::mjpeg, {32, 16}));
}

// Luminance comes out as it went in, in whatever form the picture was kept.
TEST(GreyPicture, OfEveryFormIsTheLuminance) {
  const Size size{64, 48};
  const Bytes yuyv = smooth_yuyv(size);
  Bytes luminance;
  for (std::size_t i = 0; i < yuyv.size(); i += 2) luminance.push_back(yuyv[i]);
  const auto pixels = [&](const Bytes& picture, PixelFormat format) {
    const auto grey = grey_picture(picture, frame_of(format, size));
    EXPECT_TRUE(grey) << grey.error().message;
    Bytes bytes;
    if (grey)
      for (const std::uint8_t p : grey->pixels) bytes.push_back(std::byte{p});
    return bytes;
  };
  EXPECT_EQ(pixels(yuyv, PixelFormat::yuyv), luminance);
  EXPECT_EQ(pixels(luminance, PixelFormat::grey), luminance);
  EXPECT_EQ(pixels(*raw_to_png(yuyv, PixelFormat::yuyv, 64, 48), PixelFormat::png), luminance);
  EXPECT_EQ(pixels(*raw_to_png(luminance, PixelFormat::grey, 64, 48), PixelFormat::png), luminance);
  Bytes rgb;
  for (const std::byte y : luminance) rgb.insert(rgb.end(), {y, y, y});
  const Bytes from_rgb = pixels(*rgb_to_png(rgb, 64, 48), PixelFormat::png);
  const Bytes from_jpeg = pixels(*raw_to_jpeg(luminance, PixelFormat::grey, 64, 48), PixelFormat::mjpeg);
  ASSERT_EQ(from_rgb.size(), luminance.size());
  ASSERT_EQ(from_jpeg.size(), luminance.size());
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    EXPECT_NEAR(std::to_integer<int>(from_rgb[i]), std::to_integer<int>(luminance[i]), 1);
    EXPECT_NEAR(std::to_integer<int>(from_jpeg[i]), std::to_integer<int>(luminance[i]), 4);
  }
}

TEST(GreyPicture, OfAnotherSizeOrNoPictureIsRefused) {
  const Bytes bytes = noise(64);
  for (const PixelFormat format :
       {PixelFormat::grey, PixelFormat::yuyv, PixelFormat::png, PixelFormat::mjpeg})
    for (const Size size : {Size{9, 9}, Size{0, 0}, Size{-8, -8}, Size{2'000'000, 2'000'000}}) {
      const auto grey = grey_picture(bytes, frame_of(format, size));
      ASSERT_FALSE(grey);
      EXPECT_EQ(grey.error().fault, Fault::malformed);
    }
  const auto png = rgb_to_png(noise(3 * 30), 6, 5);
  EXPECT_FALSE(grey_picture(*png, frame_of(PixelFormat::png, {5, 6})));
}

}  // namespace
}  // namespace fude
