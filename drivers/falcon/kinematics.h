// Where the grip of a Falcon is by the angles of its three legs, and what their motors must do for a force.
// The geometry is Stamper's (A Three Degree of Freedom Parallel Manipulator with Only Translational
// Degrees of Freedom, PhD thesis, University of Maryland 1997, chapter 3); the lengths are libnifalcon's.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

namespace fude::falcon {

// Metres from the middle of the base: x right, y up, z towards the user. Angles of the thighs from the plane
// of the base, radians.

double leg_angle(std::int16_t encoder_counts);

// None where a leg does not reach there.
std::optional<Eigen::Vector3d> leg_angles(const Eigen::Vector3d& position_m);

// The position before the base whose angles these are, sought from `near` (the middle of the workspace, or
// the position before); none where the legs do not meet within reach of it.
std::optional<Eigen::Vector3d> grip_position(const Eigen::Vector3d& leg_angles_rad,
                                             const Eigen::Vector3d& near);

// Change of the angles by the position; none where a leg is stretched or folded and the change has no bound.
std::optional<Eigen::Matrix3d> angle_jacobian(const Eigen::Vector3d& position_m);

// N m at the legs that hold this force at the grip, and the force that such torques give: power is the same
// on both sides, so force = Jᵀ torque. None where the Jacobian is none or cannot be inverted.
std::optional<Eigen::Vector3d> leg_torques(const Eigen::Vector3d& position_m, const Eigen::Vector3d& force_n);
std::optional<Eigen::Vector3d> grip_force(const Eigen::Vector3d& position_m,
                                          const Eigen::Vector3d& torques_nm);

}  // namespace fude::falcon
