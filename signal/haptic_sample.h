// One period of a force-feedback arm.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "signal/timestamp.h"

namespace fude {

// The device's frame: x right, y up, z towards the user, origin at the middle of its workspace.
struct HapticSample {
  SampleTime time;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();  // commanded, after every limit
  std::array<std::int32_t, 3> encoder_counts{};
  std::uint32_t buttons = 0;
  bool homed = false;  // until then the position says nothing
  bool after_gap = false;
  bool operator==(const HapticSample&) const = default;
};

}  // namespace fude
