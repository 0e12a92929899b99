// A camera, read frame by frame from the kernel's buffers (V4L2, memory-mapped).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/file_descriptor.h"
#include "drivers/transport/inbox.h"
#include "signal/byte_source.h"
#include "signal/camera_frame.h"

namespace fude {

struct CameraSettings {
  std::optional<PixelFormat> format;  // not png; none: the first of mjpeg, yuyv, grey that the camera has
  std::int32_t width = 1280;
  std::int32_t height = 720;
  double rate_hz = 30;  // 0 in what a camera made of it: it does not say
  // Where given, the camera's own control is switched off and the value held.
  std::optional<double> exposure_s;
  std::optional<std::int32_t> gain;  // in the camera's own units, as is focus
  std::optional<std::int32_t> focus;
};

class V4l2Source final : public ByteSource {
 public:
  // Opens e.g. /dev/video0 for this program alone and streams. The camera takes the nearest size and rate
  // that it has. Errors: see open_alone(); unsupported for what is no camera, or has not the format (or none
  // of the three); busy.
  static Result<std::unique_ptr<V4l2Source>> open(const std::filesystem::path& node,
                                                  const CameraSettings& settings);
  ~V4l2Source() override;

  // What the camera made of the settings, its format among them; controls are left out where it has none.
  const CameraSettings& settings() const { return settings_; }

  // One `picture`, with the time that the driver gave it where that is on CLOCK_MONOTONIC.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;
  void wake() override { inbox_.wake(); }

  // Of the picture that read() gave last: the driver's count (a gap is a loss, and after_gap says so), the
  // moment that its time names, and whether the driver calls it damaged.
  const CameraFrame& frame() const { return frame_; }

 private:
  class Mapping;
  V4l2Source(FileDescriptor file, std::filesystem::path node, CameraSettings settings);

  Result<void> choose_format();
  void choose_rate();
  void choose_controls();
  std::optional<std::int32_t> hold(std::uint32_t automatic, std::int32_t off, std::uint32_t control,
                                   std::int32_t value);
  Result<void> start();
  void take_picture(bool hung_up);
  void unplugged();

  FileDescriptor file_;
  std::filesystem::path node_;
  CameraSettings settings_;
  std::vector<Mapping> buffers_;
  Inbox inbox_;
  CameraFrame frame_;
  std::optional<std::uint32_t> counted_;  // the driver's count so far
  bool gone_ = false;
};

}  // namespace fude
