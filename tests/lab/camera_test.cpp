// The kernel's virtual camera (vivid), read by V4l2Source.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "capture/picture/frame_encoding.h"
#include "capture/picture/picture_png.h"
#include "drivers/transport/v4l2_source.h"
#include "tests/lab/reopened.h"
#include "tests/lab/replugs.h"
#include "tests/lab/session_recording.h"

namespace fude::lab {
namespace {

constexpr CameraSettings small{PixelFormat::yuyv, 640, 360, 30, {}, {}, {}};
constexpr CameraSettings smallest{PixelFormat::grey, 320, 180, 30, {}, {}, {}};

std::filesystem::path camera() {
  const auto nodes = find_nodes(NodeKind::video);
  if (!nodes || nodes->empty()) throw std::runtime_error("no camera");
  return nodes->front().path;
}

// Sets one of vivid's own controls, by the name that it shows.
void inject(const std::string& name, int value) {
  const FileDescriptor file(open(camera().c_str(), O_RDWR | O_CLOEXEC));
  v4l2_queryctrl query{};
  for (query.id = V4L2_CTRL_FLAG_NEXT_CTRL; ioctl(file.get(), VIDIOC_QUERYCTRL, &query) == 0;
       query.id |= V4L2_CTRL_FLAG_NEXT_CTRL) {
    if (name != reinterpret_cast<const char*>(query.name)) continue;
    v4l2_control control{query.id, value};
    if (ioctl(file.get(), VIDIOC_S_CTRL, &control) == 0) return;
  }
  throw std::runtime_error("the virtual camera has no control '" + name + "'");
}

// Mean luminance of the k-th of eight upright bars, in the middle third of the picture's height.
double bar(const Transfer& picture, int k) {
  double sum = 0;
  int count = 0;
  for (int y = small.height / 3; y < small.height * 2 / 3; ++y)
    for (int x = small.width * k / 8 + 8; x < small.width * (k + 1) / 8 - 8; ++x, ++count)
      sum += std::to_integer<int>(picture.payload.at(static_cast<std::size_t>(2 * (y * small.width + x))));
  return sum / count;
}

TEST(Camera, PicturesInOrderOnTheKernelsClock) {
  constexpr std::size_t count = 30;
  const Timestamp before = monotonic_now();  // vivid says when a frame was due, which may be long ago
  auto source = V4l2Source::open(camera(), small);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->settings().width, small.width);
  EXPECT_EQ((*source)->settings().height, small.height);
  const auto second = V4l2Source::open(camera(), small);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().fault, Fault::busy);

  SessionRecording recording({});
  std::vector<CameraFrame> frames;
  while (frames.size() < count) {
    ASSERT_TRUE(recording.drain_one(**source));
    frames.push_back((*source)->frame());
  }
  const Timestamp after = monotonic_now();
  const auto transfers = recording.finish();
  std::size_t missed = 0;
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(transfers[i].kind, TransferKind::picture);
    EXPECT_EQ(transfers[i].payload.size(), static_cast<std::size_t>(2 * small.width * small.height));
    EXPECT_EQ(transfers[i].stamped_by, StampedBy::kernel);
    EXPECT_EQ(transfers[i].time, frames[i].time.host);
    EXPECT_EQ(frames[i].moment, ExposureMoment::end);
    EXPECT_GE(frames[i].time.host, before - std::chrono::seconds(1));
    EXPECT_LE(frames[i].time.host, after + std::chrono::milliseconds(34));  // vivid says when a frame is due
    if (i == 0) continue;
    EXPECT_GT(frames[i].time.host, frames[i - 1].time.host);
    const std::uint64_t step = frames[i].time.sequence - frames[i - 1].time.sequence;
    EXPECT_EQ(frames[i].after_gap, step != 1);
    missed += step - 1;
  }
  // 75 % colour bars: white, yellow, cyan, green, magenta, red, blue, black grow darker.
  for (int k = 1; k < 8; ++k)
    EXPECT_LT(bar(transfers.back(), k), bar(transfers.back(), k - 1)) << "bar " << k;
  std::printf("figure: %zu pictures of a virtual camera, %zu missed by this slow guest\n", count, missed);
}

TEST(Camera, GreyPicturesAreABytePerPixel) {
  CameraSettings grey = small;
  grey.format = PixelFormat::grey;
  auto source = V4l2Source::open(camera(), grey);
  ASSERT_TRUE(source) << source.error().message;
  SessionRecording recording({});
  ASSERT_TRUE(recording.drain_one(**source));
  EXPECT_EQ(recording.last().payload.size(), static_cast<std::size_t>(small.width * small.height));
  grey.format = PixelFormat::mjpeg;  // which vivid does not have
  source->reset();
  const auto refused = V4l2Source::open(camera(), grey);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::unsupported);
}

TEST(Camera, AskedForNoFormatItTakesTheFirstThatItHas) {
  CameraSettings any = small;
  any.format.reset();
  const auto source = V4l2Source::open(camera(), any);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->settings().format, PixelFormat::yuyv);  // vivid has no mjpeg
}

TEST(Camera, ItsNodeForDataAboutPicturesIsNoCamera) {
  ASSERT_TRUE(std::filesystem::exists("/dev/video1"));
  const auto refused = V4l2Source::open("/dev/video1", small);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::unsupported);
  const auto nodes = find_nodes(NodeKind::video);
  ASSERT_TRUE(nodes);
  EXPECT_EQ(nodes->size(), 1u);
}

// A real driver's bytes, with whatever it puts into them.
TEST(Camera, EveryByteComesBackFromAPng) {
  for (const PixelFormat format : {PixelFormat::yuyv, PixelFormat::grey}) {
    CameraSettings settings = small;
    settings.format = format;
    const auto source = V4l2Source::open(camera(), settings);
    ASSERT_TRUE(source) << source.error().message;
    SessionRecording recording({});
    ASSERT_TRUE(recording.drain_one(**source));
    CameraFrame frame = (*source)->frame();
    const auto png = encoded(recording.last().payload, frame, FrameEncoding::png);
    ASSERT_TRUE(png) << png.error().message;
    EXPECT_EQ(frame.format, PixelFormat::png);
    const auto back = raw_from_png(*png);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->format, format);
    EXPECT_EQ(back->bytes, recording.last().payload);
  }
}

TEST(Camera, ControlsAreHeldWhereTheCameraHasThem) {
  CameraSettings fixed = small;
  fixed.gain = 42;
  fixed.exposure_s = 0.01;
  fixed.focus = 3;
  const auto source = V4l2Source::open(camera(), fixed);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->settings().gain, 42);
  EXPECT_FALSE((*source)->settings().exposure_s);  // vivid has neither
  EXPECT_FALSE((*source)->settings().focus);
}

TEST(Camera, DroppedAndDamagedPicturesAreMarked) {
  constexpr std::size_t count = 20;
  inject("Percentage of Dropped Buffers", 50);
  auto source = V4l2Source::open(camera(), small);
  ASSERT_TRUE(source) << source.error().message;
  SessionRecording recording({});
  std::size_t gaps = 0;
  std::optional<std::uint64_t> last;
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_TRUE(recording.drain_one(**source));
    const CameraFrame& frame = (*source)->frame();
    if (last) {
      EXPECT_EQ(frame.after_gap, frame.time.sequence != *last + 1);
    }
    gaps += frame.after_gap;
    last = frame.time.sequence;
  }
  EXPECT_GT(gaps, 0u);
  inject("Percentage of Dropped Buffers", 0);
  inject("Inject V4L2_BUF_FLAG_ERROR", 1);
  bool damaged = false;
  for (std::size_t i = 0; i < count && !damaged; ++i) {
    ASSERT_TRUE(recording.drain_one(**source));
    damaged = (*source)->frame().damaged;
  }
  EXPECT_TRUE(damaged);
}

// Taken from its driver and given back, as a camera that is pulled out and put in. The smallest pictures that
// it has, and a new session now and then: a thousand lives go through the guest's memory.
TEST(Camera, PulledOutAndPutBackInMidStream) {
  constexpr int lives_a_session = 21;
  const auto driver = [](const char* action) {
    std::ofstream(std::string("/sys/bus/platform/drivers/vivid/") + action) << "vivid.0" << std::flush;
  };
  auto source = returning(NodeKind::video,
                          "0000:0000:", [](const auto& path) { return V4l2Source::open(path, smallest); });
  std::size_t pictures = 0;
  const int lives = replugs() + 1;
  for (int life = 0; life < lives;) {
    SessionRecording recording({});
    const int end = std::min(lives, life + lives_a_session);
    const int begin = life;
    for (; life < end; ++life) {
      const std::size_t begun = recording.size();
      ASSERT_EQ(recording.drain_until(source, begun + 4), begun + 4) << "life " << life;
      wait_for_any_moment(life, std::chrono::milliseconds(100));
      driver("unbind");
      while (recording.last().kind != TransferKind::unplugged)
        ASSERT_TRUE(recording.drain_one(source)) << "life " << life;
      driver("bind");
    }
    int plugged = 0;
    int gone = 0;
    Timestamp last_mark{}, last_picture{};  // vivid stamps a picture when it was due
    for (const Transfer& transfer : recording.finish()) {
      Timestamp& last = transfer.kind == TransferKind::picture ? last_picture : last_mark;
      EXPECT_GE(transfer.time, last);
      last = transfer.time;
      if (transfer.kind == TransferKind::picture) {
        ++pictures;
        EXPECT_EQ(transfer.payload.size(), static_cast<std::size_t>(smallest.width * smallest.height));
      }
      plugged += transfer.kind == TransferKind::plugged;
      gone += transfer.kind == TransferKind::unplugged;
    }
    EXPECT_EQ(plugged, end - begin);
    EXPECT_EQ(gone, end - begin);
  }
  std::printf("figure: a camera pulled out %d times in mid-stream, %zu pictures\n", lives, pictures);
}

}  // namespace
}  // namespace fude::lab
