// Where a tracker saw a tool.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "signal/pose.h"
#include "signal/timestamp.h"

namespace fude {

// A tracker's own frame and that of one tool's markers, both as their makers draw them; metres.
struct Tracker {};
struct Tool {};

struct PoseSample {
  SampleTime time;
  std::string tool;  // as the tracker names it, or its sensor's number
  PoseOrigin origin = PoseOrigin::measured;
  Pose<Tracker, Tool> tracker_from_tool;
  // Of rotation (about the tracker's axes, rad²) then translation (m²); none where nobody states it.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
  std::optional<double> residual_m;  // the tracker's own figure of merit
  std::uint32_t buttons = 0;
  bool valid = true;  // false: the tool was not seen; the pose then says nothing
  bool after_gap = false;
};

}  // namespace fude
