// A glove with bend sensors in its fingers and lights that a receiver tower sees.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "signal/timestamp.h"
#include "signal/units.h"

namespace fude {

inline constexpr std::size_t glove_fingers = 5;  // thumb first
inline constexpr std::size_t glove_lights = 8;

struct GloveSample {
  SampleTime time;
  std::array<Fraction, glove_fingers> bend{};                       // of the sensor's range
  std::array<std::optional<Eigen::Vector3d>, glove_lights> lights;  // in the tower's frame, m; none: not seen
  std::uint32_t buttons = 0;
  bool after_gap = false;
};

}  // namespace fude
