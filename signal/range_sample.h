// One ultrasonic pulse as the receivers heard it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "signal/timestamp.h"

namespace fude {

inline constexpr std::size_t most_receivers = 8;

struct RangeSample {
  SampleTime time;           // of the pulse
  std::uint8_t emitter = 0;  // which one fired, where the brush carries several
  std::uint8_t receivers = 0;
  std::array<std::optional<double>, most_receivers> flight_s{};  // none: not heard
  std::array<double, most_receivers> amplitude{};                // 0 to 1 of full scale
  std::optional<double> temperature_c;                           // of the air
  bool after_gap = false;
  bool operator==(const RangeSample&) const = default;
};

}  // namespace fude
