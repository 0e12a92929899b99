// A force-feedback arm as a brush: where its grip is over the sheet, and what it feels there.
#pragma once

#include <Eigen/Core>

#include "drivers/falcon/haptic_loop.h"
#include "signal/contact_model.h"
#include "signal/haptic_sample.h"
#include "signal/newest.h"
#include "signal/pose.h"

namespace fude {

// The handle stands upright, its origin at the grip; 1 mm of the arm is 1 mm on the paper.
struct ArmPlace {
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  // of the arm's workspace, in Paper
};

Pose<Paper, Handle> paper_from_grip(const HapticSample& sample, const ArmPlace& place);

// The newest model's force and a damping against the paper. `models` is looked at by the loop alone and must
// outlive it. An arm of three directions feels no torque.
falcon::HapticLoop::Feel feel_of(Newest<ContactModel>& models, const ArmPlace& place);

// A plain sheet that begins to push where the handle's origin comes below this height. What it takes to hold
// it steady stands in firmware-notes/falcon.md.
ContactModel paper_plane(double touching_mm, Timestamp valid_until);

inline constexpr double paper_stiffness_n_per_mm = 0.5;
inline constexpr double paper_damping_ns_per_m = 1.0;

}  // namespace fude
