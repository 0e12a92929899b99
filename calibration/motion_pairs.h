// Two streams of poses, each with times of its own, as pairs of one moment, and the fit that joins them.
#pragma once

#include <span>
#include <vector>

#include "calibration/hand_eye.h"
#include "signal/pose_sample.h"

namespace fude {

struct PairedMotion {
  std::vector<MotionPair> pairs;  // as the other's clock is read lag_s late
  RobustHandEye robust;           // only with fewest_motion_pairs
  double lag_s = 0;
};
inline constexpr std::size_t fewest_motion_pairs = 30;
inline constexpr double longest_motion_lag_s = 0.2;

// Each stream in the order of its time. The denser is interpolated at the times of the other, never across a
// gap or 0.1 s; of more than 3000 every so many counts. The lag is found step by step, up to
// longest_motion_lag_s: beyond, it says nothing.
PairedMotion pair_motion(std::span<const PoseSample> seen, std::span<const PoseSample> other);

}  // namespace fude
