// What a brush on the paper does to the hand, near one pose: a straight-line law that a haptic loop evaluates
// a thousand times a second while the brush is being solved.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "signal/pose.h"
#include "signal/timestamp.h"

namespace fude {

// Acts on the hand at the origin of Handle; axes of Paper.
struct Wrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_nmm = Eigen::Vector3d::Zero();
};

struct ContactModel {
  Pose<Paper, Handle> paper_from_handle;  // where it was made; millimetres
  Wrench wrench;                          // there
  // What (force; torque) loses by a small (shift in mm; turn as a rotation vector in radians) from there,
  // both in axes of Paper: N/mm, N/rad; N, N mm/rad.
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  Timestamp valid_until{};
};

// What is felt at this pose; none after `valid_until`. Paper pushes and never pulls: nothing is felt where
// the law's force does not point out of the paper.
std::optional<Wrench> felt(const ContactModel& model, const Pose<Paper, Handle>& paper_from_handle,
                           Timestamp at);

}  // namespace fude
