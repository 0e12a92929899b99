// Two trackers that see the same motion: where one stands to the other, and how their tools are joined.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "signal/pose.h"
#include "signal/pose_sample.h"

namespace fude {

// The other tracker's own frame, and that of the tool it sees; metres.
struct OtherTracker {};
struct OtherTool {};

// Both at one moment, and how the other moved then.
struct MotionPair {
  Timestamp time{};
  Pose<Tracker, Tool> seen;
  Pose<OtherTracker, OtherTool> other;
  Eigen::Vector3d other_turn_radps = Eigen::Vector3d::Zero();    // in OtherTool
  Eigen::Vector3d other_velocity_mps = Eigen::Vector3d::Zero();  // in OtherTracker
};

// seen · tool_from_other = tracker_from_other · other.
struct HandEye {
  Pose<Tracker, OtherTracker> tracker_from_other;
  Pose<Tool, OtherTool> tool_from_other;
  double lag_s = 0;  // the other shows at its time t + lag_s what the first shows at t
};

struct HandEyeResidual {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();   // in Tracker
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  // about Tracker's axes
};
HandEyeResidual residual_of(const HandEye& fit, const MotionPair& pair);

// In one step: both rotations from the Kronecker product of the measured ones (Shah 2013), the translations
// linear after them. Three pairs at least, turned about two axes.
HandEye closed_hand_eye(std::span<const MotionPair> pairs);

// How many times longer the first tracker's unit would have to be for the other's translations to fit best.
double length_ratio(std::span<const MotionPair> pairs, const HandEye& fit);

inline constexpr int hand_eye_unknowns = 13;
struct RobustHandEye {
  HandEye fit;
  std::vector<bool> agrees;                  // a pair each
  std::vector<HandEyeResidual> left_out;     // of each pair by the fit without its stretch of time
  Eigen::Matrix<double, 6, 6> covariance_y;  // of tracker_from_other: turn (Tracker's axes), shift
  Eigen::Matrix<double, 6, 6> covariance_x;  // of tool_from_other: turn (Tool's axes), shift
  double lag_deviation_s = 0;
};

// The closed form of the draw of four (seeded) to which half of the pairs come nearest, refined by least
// squares over rotations, translations and lag, with all pairs within five standard deviations in place and
// turn, until these stay the same. The lag is believed to be within 20 ms of `pairs`' own. Covariances are
// the larger of the fit's own and of leaving out twentieths of the time. Twenty pairs at least.
RobustHandEye robust_hand_eye(std::span<const MotionPair> pairs);

}  // namespace fude
