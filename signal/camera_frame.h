// One picture of a camera: the bytes stay in the transfer or on disk, this says what they are.
#pragma once

#include <cstdint>
#include <optional>

#include "signal/timestamp.h"

namespace fude {

enum class PixelFormat : std::uint8_t { grey, yuyv, mjpeg, png };  // png: only in recordings

// Which moment of the exposure the time names.
enum class ExposureMoment : std::uint8_t { unknown, start, end };

struct CameraFrame {
  SampleTime time;  // sequence as the driver counts: a gap is a lost frame
  ExposureMoment moment = ExposureMoment::unknown;
  PixelFormat format = PixelFormat::grey;
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::optional<double> exposure_s;
  bool damaged = false;  // the driver or the decoder says so
  bool after_gap = false;
  bool operator==(const CameraFrame&) const = default;
};

}  // namespace fude
