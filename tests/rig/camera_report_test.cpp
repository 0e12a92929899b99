// What a user and a session are told of a camera's settings.
#include "rig/camera_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fude {
namespace {

constexpr CameraSettings wish{PixelFormat::mjpeg, 1280, 720, 30, 0.01, 42, 3};

TEST(CameraReport, ACameraThatDoesAsAskedIsNotSpokenOf) {
  EXPECT_EQ(camera_remark(wish, wish), "");
  CameraSettings nearly = wish;
  nearly.rate_hz = 29.97;
  nearly.exposure_s = 0.01004;
  EXPECT_EQ(camera_remark(wish, nearly), "");
}

TEST(CameraReport, WhatIsLeftToTheCameraIsNotSpokenOf) {
  const CameraSettings given{PixelFormat::grey, 1280, 720, 30, {}, {}, {}};
  EXPECT_EQ(camera_remark({}, given), "");
}

TEST(CameraReport, EverythingMadeOtherwiseIsToldInOneLine) {
  const CameraSettings given{PixelFormat::yuyv, 640, 480, 24.9, 0.0123, 40, {}};
  EXPECT_EQ(
      camera_remark(wish, given),
      "asked for mjpeg, gives yuyv; asked for 1280 x 720, gives 640 x 480; asked for 30 Hz, gives 24.9 Hz; "
      "asked for an exposure of 10 ms, holds 12.3 ms; asked for gain 42, holds 40; "
      "asked for focus 3, has none");
}

TEST(CameraReport, WhatTheCameraCannotDoOrTell) {
  const CameraSettings given{PixelFormat::mjpeg, 1280, 720, 0, {}, 42, 3};
  EXPECT_EQ(camera_remark(wish, given),
            "asked for 30 Hz, does not say its rate; asked for an exposure of 10 ms, cannot hold one");
}

TEST(CameraReport, TheSessionHoldsWhatTheCameraWasSetTo) {
  const auto all = nlohmann::json::parse(camera_record(wish));
  EXPECT_EQ(all, nlohmann::json::parse(R"({"format":"mjpeg","width":1280,"height":720,"rate_hz":30.0,
      "exposure_s":0.01,"gain":42,"focus":3})"));
  const auto bare = nlohmann::json::parse(camera_record({PixelFormat::grey, 8, 6, 0, {}, {}, {}}));
  EXPECT_EQ(bare, nlohmann::json::parse(R"({"format":"grey","width":8,"height":6,"rate_hz":null,
      "exposure_s":null,"gain":null,"focus":null})"));
}

}  // namespace
}  // namespace fude
