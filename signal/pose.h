// Poses that name both frames: `Pose<Paper, Handle> paper_from_handle`. Chains read left to right
// and compile only when the inner frames match.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace fude {

// The sheet: origin at its lower left corner as the painter sees it, x right, y away from the
// painter, z up out of the paper; right-handed, millimetres. The sheet lies in z = 0.
struct Paper {};

// The brush handle: origin at the root of the tuft (where hair leaves the ferrule), z along the
// handle away from the tuft, x the side that barrel rotation 0 turns to the painter's right;
// right-handed, millimetres. An unbent tuft reaches from 0 to -length along z.
struct Handle {};

// How a pose came to be. Only `measured` and `interpolated` may paint or be recorded as input.
enum class PoseOrigin : std::uint8_t { none, measured, interpolated, predicted };

template <class To, class From>
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit length
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         // of From's origin, in To

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  Pose<From, To> inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * translation)};
  }
};

template <class To, class Inner, class From>
Pose<To, From> operator*(const Pose<To, Inner>& a, const Pose<Inner, From>& b) {
  return {a.rotation * b.rotation, a * b.translation};
}

}  // namespace fude
