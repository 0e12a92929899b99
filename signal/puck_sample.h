// A six-axis controller's cap: how far it is pushed and turned from rest.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "signal/timestamp.h"

namespace fude {

// x right, y away from the user, z up; each -1 to 1 of the device's range, turns right-handed.
struct PuckSample {
  SampleTime time;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  std::uint32_t buttons = 0;
  bool after_gap = false;
  bool operator==(const PuckSample&) const = default;
};

}  // namespace fude
